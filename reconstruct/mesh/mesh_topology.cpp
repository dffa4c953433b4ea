// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/disjoint_sets.hpp>
#include <facula/reconstruct/mesh/mesh_topology.hpp>

#include <algorithm>

namespace facula {
namespace {

constexpr std::uint32_t kNone = MeshTopology::kBorder;

/// A half-edge under the higher of its two vertices; the lower one is the bucket.
struct Filed {
  std::uint32_t high;
  std::uint32_t half;
};

/// Half-edges filed under their lower vertex, each bucket in the order of the higher one.
class HalfEdgeFile {
 public:
  explicit HalfEdgeFile(const TriangleMesh& mesh) : begin_(mesh.vertices.size() + 1, 0) {
    const auto halves = static_cast<std::uint32_t>(3 * mesh.triangles.size());
    const auto ends = [&](std::uint32_t half) {
      return std::minmax(
          {MeshTopology::origin(mesh, half), MeshTopology::origin(mesh, MeshTopology::next(half))});
    };
    for (std::uint32_t half = 0; half < halves; ++half) ++begin_[ends(half).first + 1];
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    filed_.resize(halves);
    std::vector<std::uint32_t> place(begin_.begin(), begin_.end() - 1);
    for (std::uint32_t half = 0; half < halves; ++half) {
      const auto [low, high] = ends(half);
      filed_[place[low]++] = {high, half};
    }
    for (std::size_t v = 0; v + 1 < begin_.size(); ++v) {
      std::sort(filed_.begin() + begin_[v],
                filed_.begin() + begin_[v + 1],
                [](const Filed& a, const Filed& b) {
                  return a.high != b.high ? a.high < b.high : a.half < b.half;
                });
    }
  }

  /// Calls body(first, last) for the half-edges of every edge.
  template <typename Body>
  void for_each_edge(const Body& body) const {
    for (std::size_t v = 0; v + 1 < begin_.size(); ++v) {
      for (std::uint32_t i = begin_[v]; i < begin_[v + 1];) {
        std::uint32_t j = i + 1;
        while (j < begin_[v + 1] && filed_[j].high == filed_[i].high) ++j;
        body(filed_.data() + i, filed_.data() + j);
        i = j;
      }
    }
  }

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<Filed> filed_;
};

void join_corners(const TriangleMesh& mesh,
                  std::uint32_t half,
                  std::uint32_t other,
                  DisjointSets& s) {
  const std::uint32_t end = MeshTopology::next(half);
  std::uint32_t at_start = MeshTopology::next(other);  // where both triangles run as they should
  std::uint32_t at_end = other;
  if (MeshTopology::origin(mesh, at_start) != MeshTopology::origin(mesh, half)) {
    std::swap(at_start, at_end);
  }
  s.join(half, at_start);
  s.join(end, at_end);
}

/// The (up to) two boundary half-edges that touch a fan.
using Touching = std::array<std::uint32_t, 2>;

}  // namespace

MeshTopology mesh_topology(const TriangleMesh& mesh) {
  mesh.check();
  MeshTopology result;
  result.opposite.assign(3 * mesh.triangles.size(), MeshTopology::kBorder);
  HalfEdgeFile(mesh).for_each_edge([&](const Filed* first, const Filed* last) {
    ++result.edges;
    const auto count = last - first;
    if (count == 1) ++result.border_edges;
    if (count == 2) {
      result.opposite[first[0].half] = first[1].half;
      result.opposite[first[1].half] = first[0].half;
      const bool same_way =
          MeshTopology::origin(mesh, first[0].half) == MeshTopology::origin(mesh, first[1].half);
      if (same_way) ++result.turned_edges;
    }
    if (count < 3) return;
    ++result.crowded_edges;
    for (const Filed* filed = first; filed != last; ++filed) {
      result.opposite[filed->half] = MeshTopology::kCrowded;
      if (filed != first) result.crowded.push_back({first->half, filed->half});
    }
  });
  return result;
}

VertexFans vertex_fans(const TriangleMesh& mesh, const MeshTopology& topology) {
  const auto corners = static_cast<std::uint32_t>(topology.opposite.size());
  DisjointSets sets(corners);
  for (std::uint32_t half = 0; half < corners; ++half) {
    const std::uint32_t other = topology.opposite[half];
    if (other < MeshTopology::kCrowded && half < other) join_corners(mesh, half, other, sets);
  }
  VertexFans fans;
  fans.fan_of_corner.assign(corners, kNone);
  std::vector<std::uint8_t> seen(mesh.vertices.size(), 0);
  for (std::uint32_t corner = 0; corner < corners; ++corner) {
    const std::uint32_t root = sets.find(corner);
    if (root == corner) {  // the least corner of its fan
      const std::uint32_t vertex = MeshTopology::origin(mesh, corner);
      fans.fan_of_corner[corner] = static_cast<std::uint32_t>(fans.vertex_of_fan.size());
      fans.vertex_of_fan.push_back(vertex);
      if (seen[vertex] == 1) ++fans.crowded_vertices;
      if (seen[vertex] < 2) ++seen[vertex];
    }
    fans.fan_of_corner[corner] = fans.fan_of_corner[root];
  }
  return fans;
}

std::vector<std::vector<std::uint32_t>> boundary_loops(const TriangleMesh& mesh,
                                                       const MeshTopology& topology) {
  const VertexFans fans = vertex_fans(mesh, topology);
  std::vector<Touching> touching(fans.vertex_of_fan.size(), {kNone, kNone});
  const auto ends = [&](std::uint32_t half) {
    return Touching{fans.fan_of_corner[half], fans.fan_of_corner[MeshTopology::next(half)]};
  };
  const auto halves = static_cast<std::uint32_t>(topology.opposite.size());
  for (std::uint32_t half = 0; half < halves; ++half) {
    if (topology.opposite[half] != MeshTopology::kBorder) continue;
    for (const std::uint32_t fan : ends(half)) {
      touching[fan][touching[fan][0] == kNone ? 0 : 1] = half;
    }
  }
  std::vector<std::vector<std::uint32_t>> loops;
  std::vector<bool> done(halves, false);
  for (std::uint32_t first = 0; first < halves; ++first) {
    if (topology.opposite[first] != MeshTopology::kBorder || done[first]) continue;
    std::vector<std::uint32_t> loop;
    std::uint32_t half = first;
    for (std::uint32_t fan = ends(first)[1]; half != kNone && !done[half];) {
      done[half] = true;
      loop.push_back(half);
      half = touching[fan][0] == half ? touching[fan][1] : touching[fan][0];
      if (half == kNone) break;
      fan = ends(half)[0] == fan ? ends(half)[1] : ends(half)[0];
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace facula
