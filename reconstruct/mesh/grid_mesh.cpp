// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace facula {
namespace {

constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

/// Meshes one square of four cells after the other.
class GridMesher {
 public:
  GridMesher(const PolarScan& scan, const GridMeshOptions& options)
      : scan_(scan), options_(options), vertex_of_(scan.point.size(), kNoVertex) {}

  /// Cells (row, col), (row + 1, col), (row + 1, next), (row, next).
  void mesh_square(int row, int col, int next) {
    const std::array<std::size_t, 4> cell{scan_.index(row, col),
                                          scan_.index(row + 1, col),
                                          scan_.index(row + 1, next),
                                          scan_.index(row, next)};
    const Eigen::Vector3f eye = scan_.sensor_origin[static_cast<std::size_t>(col)].cast<float>();
    const bool first_shorter = diagonal(cell[0], cell[2]) <= diagonal(cell[1], cell[3]);
    // Where a corner is missing, only the triangle of the other diagonal may stand.
    const bool split_02 =
        valid(cell[0]) && valid(cell[2]) && (first_shorter || !valid(cell[1]) || !valid(cell[3]));
    if (split_02) {
      add({cell[0], cell[1], cell[2]}, eye);
      add({cell[0], cell[2], cell[3]}, eye);
    } else {
      add({cell[0], cell[1], cell[3]}, eye);
      add({cell[1], cell[2], cell[3]}, eye);
    }
  }

  TriangleMesh take() { return std::move(mesh_); }

 private:
  bool valid(std::size_t cell) const { return scan_.valid[cell] != 0; }

  float diagonal(std::size_t a, std::size_t b) const {
    return valid(a) && valid(b) ? (scan_.point[a] - scan_.point[b]).norm() : INFINITY;
  }

  void add(const std::array<std::size_t, 3>& cells, const Eigen::Vector3f& eye) {
    if (!valid(cells[0]) || !valid(cells[1]) || !valid(cells[2])) return;
    const Eigen::Vector3f& a = scan_.point[cells[0]];
    const Eigen::Vector3f& b = scan_.point[cells[1]];
    const Eigen::Vector3f& c = scan_.point[cells[2]];
    const double distance = ((a + b + c) / 3 - eye).norm();
    const double longest = std::max(options_.max_edge, options_.edge_ratio * distance);
    if ((a - b).norm() > longest || (b - c).norm() > longest || (c - a).norm() > longest) return;
    const Eigen::Vector3f normal = (b - a).cross(c - a);
    if (normal.norm() == 0) return;
    TriangleMesh::Triangle triangle{vertex(cells[0]), vertex(cells[1]), vertex(cells[2])};
    if (normal.dot(eye - a) < 0) std::swap(triangle[1], triangle[2]);
    mesh_.triangles.push_back(triangle);
  }

  std::uint32_t vertex(std::size_t cell) {
    if (vertex_of_[cell] == kNoVertex) {
      vertex_of_[cell] = static_cast<std::uint32_t>(mesh_.vertices.size());
      mesh_.vertices.push_back(scan_.point[cell]);
    }
    return vertex_of_[cell];
  }

  const PolarScan& scan_;
  const GridMeshOptions& options_;
  std::vector<std::uint32_t> vertex_of_;
  TriangleMesh mesh_;
};

}  // namespace

void GridMeshOptions::check() const {
  require(max_edge > 0 && std::isfinite(max_edge),
          "max_edge is ",
          max_edge,
          " m; give a length above 0");
  require(edge_ratio >= 0 && std::isfinite(edge_ratio),
          "edge_ratio is ",
          edge_ratio,
          "; give a share of 0 or more");
}

TriangleMesh mesh_grid(const PolarScan& scan, const GridMeshOptions& options) {
  options.check();
  scan.check();
  GridMesher mesher(scan, options);
  const int last = options.close_turn && scan.cols > 2 ? scan.cols : scan.cols - 1;
  for (int col = 0; col < last; ++col) {
    for (int row = 0; row + 1 < scan.rows; ++row) {
      mesher.mesh_square(row, col, (col + 1) % scan.cols);
    }
  }
  return mesher.take();
}

}  // namespace facula
