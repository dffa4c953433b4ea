// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/measure/convex_hull_3d.hpp>
#include <facula/reconstruct/measure/convex_hull_filter.hpp>
#include <facula/reconstruct/measure/width.hpp>
#include <facula/reconstruct/measure/width_double_double.hpp>

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
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The supporting planes of a direction.
struct Support {
  Index low = 0;     // the lowest corner
  double width = 0;  // between the planes [m]
};

/// The search over the directions in which the supporting planes touch a face and a corner, or two
/// edges; the width has its least value in one of them. Bounds are taken in doubles, with room for
/// their rounding; what they leave is measured with 32 digits.
class WidthSearch {
 public:
  WidthSearch(const Points& corners, const ConvexHull& hull) : x_(corners), hull_(hull) {
    center_ = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& x : x_) center_ += x / static_cast<double>(x_.size());
    double radius = 0;
    for (const Eigen::Vector3d& x : x_) radius = std::max(radius, (x - center_).norm());
    for (Eigen::Vector3d& x : x_) centered_.emplace_back(x - center_);
    rounding_ = 64 * std::numeric_limits<double>::epsilon() * radius;
    list_neighbours();
  }

  Width run() {
    search_faces();
    for (Index f = 0; f < hull_.faces.size(); ++f) {
      for (std::size_t e = 0; e < 3; ++e) {
        if (f < hull_.neighbours[f][e]) search_edge(f, e);
      }
    }
    return best_;
  }

 private:
  /// An edge and the way of the supporting plane's normal from one of its faces to the other.
  struct Arc {
    Index from = 0;
    Index to = 0;
    Eigen::Vector3d middle;  // halfway along
  };

  void list_neighbours() {
    std::vector<Index> count(x_.size() + 1, 0);
    for (const auto& face : hull_.faces) {
      for (const Index corner : face) ++count[corner + 1];
    }
    std::partial_sum(count.begin(), count.end(), count.begin());
    first_ = count;
    next_.resize(3 * hull_.faces.size());
    for (const auto& face : hull_.faces) {
      for (std::size_t i = 0; i < 3; ++i) next_[count[face[i]]++] = face[(i + 1) % 3];
    }
  }

  WideVector normal_of(const std::array<Index, 3>& face) const {
    return WideVector::between(x_[face[0]], x_[face[1]])
        .cross(WideVector::between(x_[face[0]], x_[face[2]]));
  }

  DoubleDouble height(const WideVector& normal, Index i) const {
    return normal.dot(WideVector::between(x_[0], x_[i]));
  }

  /// The lowest corner along the normal, walking downhill from `start`: on a convex hull nothing
  /// hides it. First in doubles, then in full where they cannot tell neighbours apart.
  Index lowest(const WideVector& normal, const Eigen::Vector3d& u, Index start) const {
    double least = u.dot(centered_[start]);
    for (Index here = kNone; here != start;) {
      here = start;
      for (Index i = first_[here]; i < first_[here + 1]; ++i) {
        const double there = u.dot(centered_[next_[i]]);
        if (there >= least) continue;
        least = there;
        start = next_[i];
      }
    }
    for (Index here = kNone; here != start;) {
      here = start;
      for (Index i = first_[here]; i < first_[here + 1]; ++i) {
        const Index there = next_[i];
        if (u.dot(centered_[there] - centered_[start]) > rounding_) continue;
        if (height(normal, there) < height(normal, start)) start = there;
      }
    }
    return start;
  }

  /// The corners that doubles cannot tell from the lowest one along u; with -u, the highest.
  std::vector<Index> lowest_in_doubles(const Eigen::Vector3d& u) const {
    double least = kInfinity;
    for (const Eigen::Vector3d& x : centered_) least = std::min(least, u.dot(x));
    std::vector<Index> result;
    for (Index i = 0; i < centered_.size(); ++i) {
      if (u.dot(centered_[i]) <= least + rounding_) result.push_back(i);
    }
    return result;
  }

  /// The lowest of these corners, in full.
  Index lowest_of(const WideVector& normal, const std::vector<Index>& corners) const {
    return *std::min_element(corners.begin(), corners.end(), [&](Index a, Index b) {
      return height(normal, a) < height(normal, b);
    });
  }

  /// Measures along the direction and keeps it if it is the best.
  Support measure(const WideVector& normal) {
    const Eigen::Vector3d u = normal.rounded().normalized();
    std::vector<Index> low = lowest_in_doubles(u);
    std::vector<Index> high = lowest_in_doubles(-u);
    const DoubleDouble bottom = height(normal, lowest_of(normal, low));
    const DoubleDouble top = height(normal, lowest_of(-normal, high));
    const double length = std::sqrt(normal.dot(normal).value());
    const Support touched{lowest_of(normal, low), (top - bottom).value() / length};
    if (touched.width >= best_.width) return touched;
    const double tie = 1e-9 * touched.width * length;
    std::erase_if(low, [&](Index i) { return (height(normal, i) - bottom).value() > tie; });
    std::erase_if(high, [&](Index i) { return (top - height(normal, i)).value() > tie; });
    best_.width = touched.width;
    best_.direction = u;
    best_.low_points = std::move(low);
    best_.high_points = std::move(high);
    return touched;
  }

  /// A face below, a corner above: every face with its opposite corner, nearest pairs first.
  void search_faces() {
    best_.width = kInfinity;
    const std::size_t count = hull_.faces.size();
    opposite_.resize(count);
    std::vector<double> widths(count);
    Index start = 0;
    for (Index f = 0; f < count; ++f) {
      const WideVector normal = normal_of(hull_.faces[f]);
      normals_.push_back(normal.rounded().normalized());
      for (const Index g : hull_.neighbours[f]) {
        if (g < f) start = opposite_[g];
      }
      start = opposite_[f] = lowest(normal, normals_[f], start);
      widths[f] = normals_[f].dot(x_[hull_.faces[f][0]] - x_[start]);
    }
    std::vector<Index> order(count);
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(
        order.begin(), order.end(), [&](Index a, Index b) { return widths[a] < widths[b]; });
    for (const Index f : order) {
      if (widths[f] > best_.width + rounding_) break;
      measure(normal_of(hull_.faces[f]));
    }
  }

  /// Two edges: while the normal turns from one face of an edge to the other, the opposite corner
  /// changes; where it does, the planes touch in two edges.
  void search_edge(Index f, std::size_t e) {
    const Index g = hull_.neighbours[f][e];
    const Index from = hull_.faces[f][e];
    const Index to = hull_.faces[f][(e + 1) % 3];
    // Both parts point halfway; the first is nothing where the faces lie back to back, as on the
    // rim of a plate, the second where they lie in one plane.
    const Eigen::Vector3d middle =
        normals_[f] + normals_[g] +
        (x_[to] - x_[from]).normalized().cross(normals_[f] - normals_[g]);
    const Arc arc{from, to, middle};
    search_arc(arc, opposite_[f], opposite_[g], 0);
  }

  /// The part of an arc with corners a and b opposite to its ends. The width along the arc is the
  /// largest of one sine wave per corner, each curved downwards; so it is least at the ends or
  /// where the opposite corner changes, and never below the larger of a's and b's waves.
  void search_arc(const Arc& arc, Index a, Index b, int depth) {
    constexpr int kDeepest = 64;
    constexpr double kSame = 1e-13;
    if (a == b || depth > kDeepest) return;
    WideVector normal =
        WideVector::between(x_[arc.from], x_[arc.to]).cross(WideVector::between(x_[a], x_[b]));
    if (normal.rounded().dot(arc.middle) < 0) normal = -normal;
    const double length = std::sqrt(normal.dot(normal).value());
    if (!(length > 0)) return;
    const double bound = normal.dot(WideVector::between(x_[a], x_[arc.from])).value() / length;
    if (bound > (1 + kSame) * best_.width) return;
    const Support touched = measure(normal);
    if (touched.low == a || touched.low == b || touched.width <= (1 + kSame) * bound) return;
    search_arc(arc, a, touched.low, depth + 1);
    search_arc(arc, touched.low, b, depth + 1);
  }

  Points x_;
  const ConvexHull& hull_;
  Eigen::Vector3d center_;
  Points centered_;
  double rounding_ = 0;              // of a height in doubles [m]
  std::vector<Index> first_, next_;  // neighbours of corner i: next_[first_[i]] to first_[i + 1]
  Points normals_;                   // of the faces, unit length
  std::vector<Index> opposite_;      // corner opposite to each face
  Width best_;
};

/// Points in one plane, on one line or in one spot: nothing lies between the planes.
Width flat_width(const Points& points, const ConvexHull& hull) {
  Width result;
  const Eigen::Vector3d along = points[hull.span[1]] - points[hull.span[0]];
  if (hull.dimension == 2) {
    const Eigen::Vector3d side = points[hull.span[2]] - points[hull.span[0]];
    result.direction = along.cross(side).normalized();
  } else if (hull.dimension == 1) {
    result.direction = along.normalized().unitOrthogonal();
  }
  for (int i = 0; i <= hull.dimension; ++i) {
    result.low_points.push_back(hull.span[static_cast<std::size_t>(i)]);
  }
  result.high_points = result.low_points;
  result.low = result.high = result.direction.dot(points[hull.span[0]]);
  result.hull_points = result.low_points.size();
  return result;
}

/// Keeps the hull's corners only and renumbers its faces; `kept` receives their old numbers.
Points corners_of(const Points& points, ConvexHull& hull, std::vector<Index>& kept) {
  std::vector<Index> number(points.size(), kNone);
  Points corners;
  for (auto& face : hull.faces) {
    for (Index& corner : face) {
      if (number[corner] == kNone) {
        number[corner] = static_cast<Index>(corners.size());
        corners.push_back(points[corner]);
        kept.push_back(corner);
      }
      corner = number[corner];
    }
  }
  return corners;
}

}  // namespace

Width width_of(const Points& points, const WidthOptions& options) {
  require(!points.empty(), "expected points to measure the width of, got none");
  const std::vector<Index> candidates = hull_candidates(points, options.num_threads);
  Points near_hull;
  near_hull.reserve(candidates.size());
  for (const Index i : candidates) near_hull.push_back(points[i]);
  ConvexHull hull = convex_hull_3d(near_hull);
  std::vector<Index> kept;
  Width width;
  if (hull.dimension < 3) {
    width = flat_width(near_hull, hull);
    kept.resize(near_hull.size());
    std::iota(kept.begin(), kept.end(), Index{0});
  } else {
    const Points corners = corners_of(near_hull, hull, kept);
    width = WidthSearch(corners, hull).run();
    width.hull_points = corners.size();
  }
  for (Index& i : width.low_points) i = candidates[kept[i]];
  for (Index& i : width.high_points) i = candidates[kept[i]];
  width.low = width.direction.dot(points[width.low_points.front()]);
  width.high = width.direction.dot(points[width.high_points.front()]);
  return width;
}

}  // namespace facula
