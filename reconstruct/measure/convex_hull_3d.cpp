// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/measure/convex_hull_3d.hpp>
#include <facula/reconstruct/measure/convex_hull_exact.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Index = std::uint32_t;
using Points = std::vector<Eigen::Vector3d>;

constexpr Index kNone = std::numeric_limits<Index>::max();

struct Face {
  std::array<Index, 3> corner{};
  std::array<Index, 3> neighbour{kNone, kNone, kNone};
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // not of unit length
  double doubt = 0;            // |height| above doubt times the 1-norm of x - corner is certain
  std::vector<Index> outside;  // points above this face, in no other face's list
  Index farthest = kNone;
  double farthest_height = 0;
  bool alive = true;
};

/// Points that span as many dimensions as there are, and how many those are.
struct Simplex {
  std::array<Index, 4> corner{};
  int dimension = 0;
};

/// Index of the point with the largest score.
template <typename Score>
Index largest(const Points& points, const Score& score) {
  Index best = 0;
  double most = -1;
  for (Index i = 0; i < points.size(); ++i) {
    const double value = score(points[i]);
    if (value > most) {
      most = value;
      best = i;
    }
  }
  return best;
}

/// The guess, where it passes the exact test, else the first point that does, else kNone.
template <typename Test>
Index first_passing(const Points& points, Index guess, const Test& test) {
  if (test(points[guess])) return guess;
  for (Index i = 0; i < points.size(); ++i) {
    if (test(points[i])) return i;
  }
  return kNone;
}

Simplex first_simplex(const Points& points) {
  Simplex simplex;
  const Index start =
      largest(points, [&](const Eigen::Vector3d& x) { return (x - points.front()).squaredNorm(); });
  const Eigen::Vector3d a = points[start];
  const Index second = first_passing(
      points,
      largest(points, [&](const Eigen::Vector3d& x) { return (x - a).squaredNorm(); }),
      [&](const Eigen::Vector3d& x) { return x != a; });
  simplex.corner.fill(start);
  if (second == kNone) return simplex;
  simplex.dimension = 1;
  simplex.corner[1] = second;
  const Eigen::Vector3d b = points[second];
  const Index third = first_passing(
      points,
      largest(points, [&](const Eigen::Vector3d& x) { return (b - a).cross(x - a).squaredNorm(); }),
      [&](const Eigen::Vector3d& x) { return !on_one_line(a, b, x); });
  if (third == kNone) return simplex;
  simplex.dimension = 2;
  simplex.corner[2] = third;
  const Eigen::Vector3d c = points[third];
  const Eigen::Vector3d normal = (b - a).cross(c - a);
  const Index fourth = first_passing(
      points,
      largest(points, [&](const Eigen::Vector3d& x) { return std::abs(normal.dot(x - a)); }),
      [&](const Eigen::Vector3d& x) { return side_of_plane(a, b, c, x) != 0; });
  if (fourth == kNone) return simplex;
  simplex.dimension = 3;
  simplex.corner[3] = fourth;
  if (side_of_plane(a, b, c, points[fourth]) > 0) std::swap(simplex.corner[1], simplex.corner[2]);
  return simplex;
}

class QuickHull {
 public:
  QuickHull(const Points& points, const Simplex& simplex)
      : points_(points), face_at_(points.size(), kNone) {
    const auto& [a, b, c, d] = simplex.corner;  // d lies below a, b, c
    for (const std::array<Index, 3>& corner :
         {std::array{a, b, c}, std::array{a, d, b}, std::array{b, d, c}, std::array{c, d, a}}) {
      add_face(corner);
    }
    faces_[0].neighbour = {1, 2, 3};
    faces_[1].neighbour = {3, 2, 0};
    faces_[2].neighbour = {1, 3, 0};
    faces_[3].neighbour = {2, 1, 0};
    std::vector<Index> all(points.size());
    std::iota(all.begin(), all.end(), Index{0});
    share_out(all, 0);
  }

  void grow() {
    for (Index f = 0; f < faces_.size(); ++f) {  // new faces come at the end
      if (faces_[f].alive && faces_[f].farthest != kNone) add_point(f);
    }
  }

  ConvexHull result() const {
    ConvexHull hull;
    hull.dimension = 3;
    std::vector<Index> number(faces_.size(), kNone);
    Index count = 0;
    for (Index f = 0; f < faces_.size(); ++f) {
      if (faces_[f].alive) number[f] = count++;
    }
    for (const Face& face : faces_) {
      if (!face.alive) continue;
      hull.faces.push_back(face.corner);
      hull.neighbours.push_back(
          {number[face.neighbour[0]], number[face.neighbour[1]], number[face.neighbour[2]]});
    }
    return hull;
  }

 private:
  /// An edge of the rim seen from the new point, as the face that goes has it.
  struct RimEdge {
    Index from = 0;
    Index to = 0;
    Index beyond = 0;  // the face that stays
  };

  void add_face(const std::array<Index, 3>& corner) {
    Face face;
    face.corner = corner;
    const Eigen::Vector3d u = points_[corner[1]] - points_[corner[0]];
    const Eigen::Vector3d v = points_[corner[2]] - points_[corner[0]];
    face.normal = u.cross(v);
    face.doubt = 16 * 1.2e-16 * u.lpNorm<1>() * v.lpNorm<1>();
    faces_.push_back(std::move(face));
  }

  /// Whether x lies above the face; `height` receives how far, in units of the face's normal.
  bool above(const Face& face, const Eigen::Vector3d& x, double& height) const {
    const Eigen::Vector3d d = x - points_[face.corner[0]];
    height = face.normal.dot(d);
    if (std::abs(height) > face.doubt * d.lpNorm<1>()) return height > 0;
    return side_of_plane(
               points_[face.corner[0]], points_[face.corner[1]], points_[face.corner[2]], x) > 0;
  }

  /// Gives every point to the first of the faces from `first` on that it lies above; those above
  /// none are inside for good.
  void share_out(const std::vector<Index>& indices, std::size_t first) {
    double height = 0;
    for (const Index i : indices) {
      for (std::size_t f = first; f < faces_.size(); ++f) {
        Face& face = faces_[f];
        if (!above(face, points_[i], height)) continue;
        face.outside.push_back(i);
        if (face.farthest == kNone || height > face.farthest_height) {
          face.farthest = i;
          face.farthest_height = height;
        }
        break;
      }
    }
  }

  /// Takes away the faces that see the point; keeps the rim around them and the points they had.
  void take_visible(Index start, Index point) {
    rim_.clear();
    orphans_.clear();
    visible_.assign(1, start);
    faces_[start].alive = false;
    double height = 0;
    for (std::size_t next = 0; next < visible_.size(); ++next) {
      const Index f = visible_[next];
      for (std::size_t e = 0; e < 3; ++e) {
        const Index beyond = faces_[f].neighbour[e];
        if (!faces_[beyond].alive) continue;
        if (above(faces_[beyond], points_[point], height)) {
          faces_[beyond].alive = false;
          visible_.push_back(beyond);
        } else {
          rim_.push_back({faces_[f].corner[e], faces_[f].corner[(e + 1) % 3], beyond});
        }
      }
    }
    for (const Index f : visible_) {
      orphans_.insert(orphans_.end(), faces_[f].outside.begin(), faces_[f].outside.end());
      std::vector<Index>().swap(faces_[f].outside);
    }
  }

  /// A fan from the rim to the point. The rim is one simple ring, because the hull is convex and
  /// the decisions are exact.
  void close_rim(Index point) {
    const auto first = static_cast<Index>(faces_.size());
    for (const RimEdge& edge : rim_) {
      const auto f = static_cast<Index>(faces_.size());
      add_face({edge.from, edge.to, point});
      faces_[f].neighbour[0] = edge.beyond;
      face_at_[edge.from] = f;
      Face& beyond = faces_[edge.beyond];
      for (std::size_t e = 0; e < 3; ++e) {
        if (beyond.corner[e] == edge.to && beyond.corner[(e + 1) % 3] == edge.from) {
          beyond.neighbour[e] = f;
        }
      }
    }
    for (Index f = first; f < faces_.size(); ++f) {
      const Index next = face_at_[faces_[f].corner[1]];
      faces_[f].neighbour[1] = next;
      faces_[next].neighbour[2] = f;
    }
  }

  void add_point(Index f) {
    const Index point = faces_[f].farthest;
    take_visible(f, point);
    const std::size_t first = faces_.size();
    close_rim(point);
    share_out(orphans_, first);
  }

  const Points& points_;
  std::vector<Face> faces_;
  std::vector<Index> face_at_;  // per point: the new face whose rim edge begins there
  std::vector<Index> visible_;
  std::vector<Index> orphans_;
  std::vector<RimEdge> rim_;
};

}  // namespace

ConvexHull convex_hull_3d(const std::vector<Eigen::Vector3d>& points) {
  require(!points.empty(), "expected points for a convex hull, got none");
  require(points.size() < kNone, "expected fewer than 2^32 points, got ", points.size());
  const Simplex simplex = first_simplex(points);
  if (simplex.dimension < 3) {
    ConvexHull flat;
    flat.dimension = simplex.dimension;
    flat.span = {simplex.corner[0], simplex.corner[1], simplex.corner[2]};
    return flat;
  }
  QuickHull hull(points, simplex);
  hull.grow();
  return hull.result();
}

}  // namespace facula
