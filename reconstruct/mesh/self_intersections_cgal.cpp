// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/mesh/mesh_verdict.hpp>
#include <facula/reconstruct/mesh/triangle_tree.hpp>

#include <algorithm>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

namespace facula {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Pair = std::array<std::uint32_t, 2>;

Point to_cgal(const Eigen::Vector3f& p) {
  return {p.x(), p.y(), p.z()};
}

/// Two triangles with what they share in front: `shared` corners are equal in both.
class TrianglePair {
 public:
  TrianglePair(const TriangleMesh& mesh, Pair pair)
      : a_(mesh.triangles[pair[0]]), b_(mesh.triangles[pair[1]]) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto* found = std::find(b_.begin() + shared_, b_.end(), a_[i]);
      if (found == b_.end()) continue;
      std::swap(b_[static_cast<std::size_t>(shared_)],
                b_[static_cast<std::size_t>(found - b_.begin())]);
      std::swap(a_[static_cast<std::size_t>(shared_)], a_[i]);
      ++shared_;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      p_[i] = to_cgal(mesh.vertices[a_[i]]);
      q_[i] = to_cgal(mesh.vertices[b_[i]]);
    }
  }

  bool intersects() const {
    if (shared_ == 3) return true;
    if (shared_ == 2) return folds_onto_itself();
    if (shared_ == 1) return meets_beyond_a_vertex();
    return !apart(p_, q_, 0) && !apart(q_, p_, 0) &&
           CGAL::do_intersect(Kernel::Triangle_3(p_[0], p_[1], p_[2]),
                              Kernel::Triangle_3(q_[0], q_[1], q_[2]));
  }

 private:
  using Corners = std::array<Point, 3>;

  /// Whether the corners of `other` from `first` on lie strictly on one side of the plane.
  static bool apart(const Corners& plane, const Corners& other, std::size_t first) {
    const auto side = [&](std::size_t i) {
      return CGAL::orientation(plane[0], plane[1], plane[2], other[i]);
    };
    const CGAL::Orientation one = side(first);
    if (one == CGAL::COPLANAR) return false;
    for (std::size_t i = first + 1; i < 3; ++i) {
      if (side(i) != one) return false;
    }
    return true;
  }

  /// Triangles at one edge overlap only when they lie in one plane on the same side of it.
  bool folds_onto_itself() const {
    return CGAL::orientation(p_[0], p_[1], p_[2], q_[2]) == CGAL::COPLANAR &&
           CGAL::coplanar_orientation(p_[0], p_[1], p_[2], q_[2]) == CGAL::POSITIVE;
  }

  /// What two triangles share beyond a common corner reaches the edge opposite to it in one.
  bool meets_beyond_a_vertex() const {
    if (apart(p_, q_, 1) || apart(q_, p_, 1)) return false;
    return CGAL::do_intersect(Kernel::Triangle_3(p_[0], p_[1], p_[2]),
                              Kernel::Segment_3(q_[1], q_[2])) ||
           CGAL::do_intersect(Kernel::Triangle_3(q_[0], q_[1], q_[2]),
                              Kernel::Segment_3(p_[1], p_[2]));
  }

  TriangleMesh::Triangle a_;
  TriangleMesh::Triangle b_;
  Corners p_;
  Corners q_;
  std::ptrdiff_t shared_ = 0;
};

bool has_no_area(const TriangleMesh& mesh, const TriangleMesh::Triangle& t) {
  for (const std::uint32_t v : t) {
    if (!mesh.vertices[v].allFinite()) return true;
  }
  return CGAL::collinear(
      to_cgal(mesh.vertices[t[0]]), to_cgal(mesh.vertices[t[1]]), to_cgal(mesh.vertices[t[2]]));
}

}  // namespace

std::vector<std::uint8_t> triangles_without_area(const TriangleMesh& mesh) {
  mesh.check();
  std::vector<std::uint8_t> flat(mesh.triangles.size());
  for (std::size_t t = 0; t < flat.size(); ++t) flat[t] = has_no_area(mesh, mesh.triangles[t]);
  return flat;
}

std::vector<Pair> self_intersections(const TriangleMesh& mesh, int num_threads) {
  constexpr std::size_t kChunk = 1024;
  const std::vector<std::uint8_t> flat = triangles_without_area(mesh);
  const TriangleTree tree(mesh);
  std::vector<std::vector<Pair>> parts(mesh.triangles.size() / kChunk + 1);
  const auto search = [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> meeting;
    for (std::size_t t = begin; t < end; ++t) {
      if (flat[t] != 0) continue;
      meeting.clear();
      tree.add_meeting(static_cast<std::uint32_t>(t), meeting);
      std::sort(meeting.begin(), meeting.end());
      for (const std::uint32_t other : meeting) {
        const Pair pair{static_cast<std::uint32_t>(t), other};
        if (flat[other] == 0 && TrianglePair(mesh, pair).intersects()) {
          parts[begin / kChunk].push_back(pair);
        }
      }
    }
  };
  parallel_for(mesh.triangles.size(), search, {num_threads, kChunk});
  std::vector<Pair> pairs;
  for (const auto& part : parts) pairs.insert(pairs.end(), part.begin(), part.end());
  return pairs;
}

}  // namespace facula
