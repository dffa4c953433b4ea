// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/mesh/mesh_cleaning.hpp>
#include <facula/reconstruct/mesh/mesh_topology.hpp>
#include <facula/reconstruct/mesh/mesh_verdict.hpp>

#include <algorithm>
#include <array>
#include <deque>

#include <Eigen/Geometry>

namespace facula {
namespace {

double area_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Eigen::Vector3d corner = mesh.vertices[a].cast<double>();
  return (mesh.vertices[b].cast<double>() - corner)
             .cross(mesh.vertices[c].cast<double>() - corner)
             .norm() /
         2;
}

std::vector<std::uint8_t> doubles_of(const TriangleMesh& mesh) {
  std::vector<std::pair<TriangleMesh::Triangle, std::size_t>> sorted;
  sorted.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    TriangleMesh::Triangle triangle = mesh.triangles[t];
    std::sort(triangle.begin(), triangle.end());
    sorted.emplace_back(triangle, t);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::uint8_t> marked(mesh.triangles.size(), 0);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) marked[sorted[i].second] = 1;
  }
  return marked;
}

/// At edges of three triangles or more, all but the two of the largest area.
std::vector<std::uint8_t> crowding(const TriangleMesh& mesh, const MeshTopology& topology) {
  std::vector<std::uint8_t> marked(mesh.triangles.size(), 0);
  for (std::size_t i = 0; i < topology.crowded.size();) {
    std::vector<std::uint32_t> triangles{topology.crowded[i][0] / 3};
    const std::uint32_t first = topology.crowded[i][0];
    for (; i < topology.crowded.size() && topology.crowded[i][0] == first; ++i) {
      triangles.push_back(topology.crowded[i][1] / 3);
    }
    std::stable_sort(triangles.begin(), triangles.end(), [&](std::uint32_t a, std::uint32_t b) {
      return area_of(mesh, a) > area_of(mesh, b);
    });
    for (std::size_t k = 2; k < triangles.size(); ++k) marked[triangles[k]] = 1;
  }
  return marked;
}

/// Turns triangles to agree with their neighbours, piece by piece, each as most of its area lay.
/// Marks those that cannot agree (where a Moebius band must be cut).
class Turner {
 public:
  Turner(TriangleMesh& mesh, const MeshTopology& topology)
      : mesh_(mesh), topology_(topology), side_(mesh.triangles.size(), kUnseen) {}

  std::size_t turn(std::vector<std::uint8_t>& misfits) {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      if (side_[t] == kUnseen) spread_from(t);
    }
    misfits.assign(mesh_.triangles.size(), 0);
    for (std::uint32_t half = 0; half < topology_.opposite.size(); ++half) {
      const std::uint32_t other = topology_.opposite[half];
      if (other >= MeshTopology::kCrowded || half > other) continue;
      const bool agree = (side_[half / 3] == side_[other / 3]) != runs_along(half, other);
      if (!agree) misfits[std::max(half, other) / 3] = 1;
    }
    std::size_t turned = 0;
    for (std::size_t t = 0; t < side_.size(); ++t) {
      if (side_[t] == 0) continue;
      std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
      ++turned;
    }
    return turned;
  }

 private:
  static constexpr std::uint8_t kUnseen = 2;

  /// Whether both half-edges run the same way, so that one triangle is turned.
  bool runs_along(std::uint32_t half, std::uint32_t other) const {
    return MeshTopology::origin(mesh_, half) == MeshTopology::origin(mesh_, other);
  }

  void spread_from(std::uint32_t seed) {
    std::array<double, 2> area{0, 0};
    std::deque<std::uint32_t> piece{seed};
    side_[seed] = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const std::uint32_t t = piece[i];
      area[side_[t]] += area_of(mesh_, t);
      for (std::uint32_t half = 3 * t; half < 3 * t + 3; ++half) {
        const std::uint32_t other = topology_.opposite[half];
        if (other >= MeshTopology::kCrowded || side_[other / 3] != kUnseen) continue;
        side_[other / 3] = runs_along(half, other) ? 1 - side_[t] : side_[t];
        piece.push_back(other / 3);
      }
    }
    if (area[1] <= area[0]) return;
    for (const std::uint32_t t : piece) side_[t] = 1 - side_[t];
  }

  TriangleMesh& mesh_;
  const MeshTopology& topology_;
  std::vector<std::uint8_t> side_;  ///< 1 = to be turned
};

/// Fans that met in one point keep this share of the way to their other corners from it.
constexpr float kPartingShare = 0.05F;

/// Moves the vertices of fans that met in one point a little into their own fan: two vertices at
/// the same place would still touch.
void part_fans(TriangleMesh& mesh, const std::vector<std::uint8_t>& shared) {
  std::vector<Eigen::Vector3f> sum(mesh.vertices.size(), Eigen::Vector3f::Zero());
  std::vector<float> count(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (shared[t[i]] == 0) continue;
      sum[t[i]] += mesh.vertices[t[(i + 1) % 3]] + mesh.vertices[t[(i + 2) % 3]];
      count[t[i]] += 2;
    }
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (count[v] == 0) continue;
    mesh.vertices[v] += kPartingShare * (sum[v] / count[v] - mesh.vertices[v]);
  }
}

/// Gives every fan of triangles a vertex of its own; returns how many vertices were added.
std::size_t split_fans(TriangleMesh& mesh) {
  const VertexFans fans = vertex_fans(mesh, mesh_topology(mesh));
  if (fans.crowded_vertices == 0) return 0;
  std::vector<std::uint32_t> vertex_of(fans.vertex_of_fan);
  std::vector<std::uint8_t> taken(mesh.vertices.size(), 0);
  std::vector<std::uint8_t> shared(mesh.vertices.size(), 0);
  const std::size_t before = mesh.vertices.size();
  for (std::uint32_t& vertex : vertex_of) {
    const std::uint32_t old = vertex;
    if (taken[old] == 0) {
      taken[old] = 1;
      continue;
    }
    vertex = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.push_back(Eigen::Vector3f(mesh.vertices[old]));
    if (!mesh.normals.empty()) mesh.normals.push_back(Eigen::Vector3f(mesh.normals[old]));
    if (!mesh.colors.empty()) mesh.colors.push_back(Color(mesh.colors[old]));
    shared[old] = 1;
    shared.push_back(1);
  }
  for (std::uint32_t corner = 0; corner < fans.fan_of_corner.size(); ++corner) {
    mesh.triangles[corner / 3][corner % 3] = vertex_of[fans.fan_of_corner[corner]];
  }
  part_fans(mesh, shared);
  return mesh.vertices.size() - before;
}

}  // namespace

TriangleMesh repaired(const TriangleMesh& mesh, RepairCounts* counts) {
  TriangleMesh result = mesh;
  RepairCounts done;
  done.bad_triangles = remove_triangles(result, triangles_without_area(result));
  done.double_triangles = remove_triangles(result, doubles_of(result));
  // Without the extra triangles of one edge another edge may hang on to two only.
  done.crowded_triangles = remove_triangles(result, crowding(result, mesh_topology(result)));
  const MeshTopology topology = mesh_topology(result);
  std::vector<std::uint8_t> misfits(result.triangles.size(), 0);
  if (topology.turned_edges > 0) {
    done.turned_triangles = Turner(result, topology).turn(misfits);
    done.crowded_triangles += remove_triangles(result, misfits);
  }
  done.split_vertices = split_fans(result);
  if (counts != nullptr) *counts = done;
  return compacted(result);
}

}  // namespace facula
