// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/point_spacing.hpp>
#include <facula/reconstruct/mesh/range_surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr std::size_t kColumnsPerChunk = 16;
constexpr float kMaxStep = 3;     // an edge may be so many times the usual step wide
constexpr float kMaxStretch = 4;  // and as deep as if it were so many finer steps wide
constexpr float kSigmaBand = 3;   // noise alone may make an edge so deep

/// An edge cut into its parts along and across the line of sight [m].
struct EdgeParts {
  float along = 0;
  float across = 0;
};

/// Meshes the grid of one scan.
class GridSurface {
 public:
  GridSurface(const PosedCloud& scan, const SightLines& sight, const RangeSurfaceOptions& options)
      : cloud_(scan.cloud), grid_(scan.grid), sight_(sight), options_(options) {
    slope_ = static_cast<float>(std::tan(options.max_incidence));
  }

  RangeSurface build() {
    measure_steps();
    mesh_squares();
    weigh_vertices();
    return std::move(surface_);
  }

 private:
  std::int32_t usable(int row, int col) const {
    const std::int32_t p = grid_.point[grid_.index(row, col)];
    if (p == ScanGrid::kNone) return p;
    return sight_.toward[static_cast<std::size_t>(p)].isZero() ? ScanGrid::kNone : p;
  }

  EdgeParts parts(std::int32_t a, std::int32_t b) const {
    const auto i = static_cast<std::size_t>(a);
    const auto j = static_cast<std::size_t>(b);
    const Eigen::Vector3f edge = cloud_.points[j] - cloud_.points[i];
    const Eigen::Vector3f way = (sight_.toward[i] + sight_.toward[j]).normalized();
    const float along = std::abs(edge.dot(way));
    return {along, std::sqrt(std::max(0.0F, edge.squaredNorm() - along * along))};
  }

  /// Median step to the next cell at (row + down, col + right), across the line of sight and as a
  /// share of the distance [1].
  float median_step(int down, int right) const {
    std::vector<float> steps;
    for (int col = 0; col + right < grid_.cols; ++col) {
      for (int row = 0; row + down < grid_.rows; ++row) {
        const std::int32_t a = usable(row, col);
        const std::int32_t b = usable(row + down, col + right);
        if (a == ScanGrid::kNone || b == ScanGrid::kNone) continue;
        const float across = parts(a, b).across;
        steps.push_back(across / sight_.distance[static_cast<std::size_t>(a)]);
      }
    }
    return static_cast<float>(quantile(std::move(steps), 0.5));
  }

  void measure_steps() {
    row_step_ = median_step(1, 0);
    col_step_ = median_step(0, 1);
    if (row_step_ == 0) row_step_ = col_step_;
    if (col_step_ == 0) col_step_ = row_step_;
    std::vector<float> distance = sight_.distance;
    surface_.step = std::sqrt(static_cast<double>(row_step_) * static_cast<double>(col_step_)) *
                    quantile(std::move(distance), 0.5);
    closed_turn_ = turn_is_closed();
  }

  /// Whether the last column lies as near the first as other neighbours lie.
  bool turn_is_closed() const {
    if (grid_.cols < 4) return false;
    std::vector<float> steps;
    for (int row = 0; row < grid_.rows; ++row) {
      const std::int32_t a = usable(row, grid_.cols - 1);
      const std::int32_t b = usable(row, 0);
      if (a == ScanGrid::kNone || b == ScanGrid::kNone) continue;
      const EdgeParts gap = parts(a, b);
      steps.push_back(std::hypot(gap.along, gap.across) /
                      sight_.distance[static_cast<std::size_t>(a)]);
    }
    return !steps.empty() && quantile(std::move(steps), 0.5) < 1.5 * col_step_;
  }

  bool joined(std::int32_t a, std::int32_t b) const {
    const EdgeParts edge = parts(a, b);
    const float distance = sight_.distance[static_cast<std::size_t>(a)];
    if (edge.across > kMaxStep * std::hypot(row_step_, col_step_) * distance) return false;
    const float wide =
        std::min(edge.across, kMaxStretch * std::min(row_step_, col_step_) * distance);
    float noise = 0;
    if (!cloud_.sigma.empty()) {
      noise = std::hypot(cloud_.sigma[static_cast<std::size_t>(a)],
                         cloud_.sigma[static_cast<std::size_t>(b)]);
    }
    return edge.along <= slope_ * wide + kSigmaBand * noise;
  }

  bool triangle(std::int32_t a,
                std::int32_t b,
                std::int32_t c,
                std::vector<TriangleMesh::Triangle>& out) const {
    if (a == ScanGrid::kNone || b == ScanGrid::kNone || c == ScanGrid::kNone) return false;
    if (!joined(a, b) || !joined(b, c) || !joined(c, a)) return false;
    TriangleMesh::Triangle corners{static_cast<std::uint32_t>(a),
                                   static_cast<std::uint32_t>(b),
                                   static_cast<std::uint32_t>(c)};
    const Eigen::Vector3f& origin = cloud_.points[corners[0]];
    const Eigen::Vector3f normal =
        (cloud_.points[corners[1]] - origin).cross(cloud_.points[corners[2]] - origin);
    if (normal.isZero(0)) return false;
    if (normal.dot(sight_.toward[corners[0]]) < 0) std::swap(corners[1], corners[2]);
    out.push_back(corners);
    return true;
  }

  /// Two triangles, or one where a corner is missing; true when the square is full.
  bool mesh_square(int row, int col, std::vector<TriangleMesh::Triangle>& out) const {
    const int next = (col + 1) % grid_.cols;
    const std::array<std::int32_t, 4> p{
        usable(row, col), usable(row + 1, col), usable(row + 1, next), usable(row, next)};
    const auto diagonal = [&](std::size_t a, std::size_t b) {
      if (p[a] == ScanGrid::kNone || p[b] == ScanGrid::kNone) return INFINITY;
      return (cloud_.points[static_cast<std::size_t>(p[a])] -
              cloud_.points[static_cast<std::size_t>(p[b])])
          .squaredNorm();
    };
    const float first = diagonal(0, 2);
    const float second = diagonal(1, 3);
    if (!std::isfinite(first) && !std::isfinite(second)) return false;
    const bool missing_13 = !std::isfinite(second);
    const bool missing_02 = !std::isfinite(first);
    if (!missing_02 && (missing_13 || first <= second)) {
      const bool one = triangle(p[0], p[1], p[2], out);
      return triangle(p[0], p[2], p[3], out) && one;
    }
    const bool one = triangle(p[0], p[1], p[3], out);
    return triangle(p[1], p[2], p[3], out) && one;
  }

  void mesh_squares() {
    const int last = closed_turn_ ? grid_.cols : grid_.cols - 1;
    const auto columns = static_cast<std::size_t>(std::max(0, last));
    std::vector<std::vector<TriangleMesh::Triangle>> pieces(columns / kColumnsPerChunk + 1);
    full_.assign(grid_.point.size(), 0);
    const auto mesh_columns = [&](std::size_t begin, std::size_t end) {
      auto& piece = pieces[begin / kColumnsPerChunk];
      for (std::size_t c = begin; c < end; ++c) {
        const int col = static_cast<int>(c);
        for (int row = 0; row + 1 < grid_.rows; ++row) {
          full_[grid_.index(row, col)] = mesh_square(row, col, piece) ? 1 : 0;
        }
      }
    };
    parallel_for(
        columns, mesh_columns, {.num_threads = options_.num_threads, .chunk = kColumnsPerChunk});
    for (const auto& piece : pieces) {
      surface_.triangles.insert(surface_.triangles.end(), piece.begin(), piece.end());
    }
  }

  bool square_full(int row, int col) const {
    if (row < 0) return false;
    if (col < 0) {
      if (!closed_turn_) return false;
      col = grid_.cols - 1;
    }
    return full_[grid_.index(row, col)] != 0;
  }

  /// Cells to the nearest one at the border of the surface, counted in steps to the eight
  /// neighbours.
  std::vector<std::uint16_t> border_distance() const {
    constexpr std::uint16_t kFar = 0x7fff;
    std::vector<std::uint16_t> cells(grid_.point.size(), 0);
    for (int col = 0; col < grid_.cols; ++col) {
      for (int row = 0; row < grid_.rows; ++row) {
        const bool inside = square_full(row, col) && square_full(row - 1, col) &&
                            square_full(row, col - 1) && square_full(row - 1, col - 1);
        cells[grid_.index(row, col)] = inside ? kFar : 0;
      }
    }
    const auto relax = [&](int row, int col, int side) {
      std::uint16_t& here = cells[grid_.index(row, col)];
      const auto look = [&](int r, int c) {
        if (r < 0 || c < 0 || r >= grid_.rows || c >= grid_.cols) return;
        const auto next = static_cast<std::uint16_t>(cells[grid_.index(r, c)] + 1);
        here = std::min(here, next);
      };
      for (int d = -1; d <= 1; ++d) look(row + d, col + side);
      look(row + side, col);
    };
    for (int col = 0; col < grid_.cols; ++col) {
      for (int row = 0; row < grid_.rows; ++row) relax(row, col, -1);
    }
    for (int col = grid_.cols - 1; col >= 0; --col) {
      for (int row = grid_.rows - 1; row >= 0; --row) relax(row, col, 1);
    }
    return cells;
  }

  /// Area-weighted normals of the vertices, not scaled; zero where no triangle ends.
  std::vector<Eigen::Vector3f> vertex_normals() const {
    std::vector<Eigen::Vector3f> normals(cloud_.size(), Eigen::Vector3f::Zero());
    for (const auto& [a, b, c] : surface_.triangles) {
      const Eigen::Vector3f normal =
          (cloud_.points[b] - cloud_.points[a]).cross(cloud_.points[c] - cloud_.points[a]);
      normals[a] += normal;
      normals[b] += normal;
      normals[c] += normal;
    }
    return normals;
  }

  void weigh_vertices() {
    const std::vector<std::uint16_t> border = border_distance();
    const std::vector<Eigen::Vector3f> normals = vertex_normals();
    const auto fade = static_cast<float>(std::max(1.0, options_.border_cells));
    surface_.vertices.resize(cloud_.size());
    for (std::size_t cell = 0; cell < grid_.point.size(); ++cell) {
      if (grid_.point[cell] == ScanGrid::kNone) continue;
      const auto p = static_cast<std::size_t>(grid_.point[cell]);
      SightVertex& vertex = surface_.vertices[p];
      vertex.point = cloud_.points[p];
      vertex.toward = sight_.toward[p];
      const float length = normals[p].norm();
      if (length == 0) {
        ++surface_.skipped_points;
        continue;
      }
      vertex.cosine = std::clamp(normals[p].dot(vertex.toward) / length, 0.05F, 1.0F);
      const float ramp = std::min(1.0F, (static_cast<float>(border[cell]) + 0.5F) / fade);
      vertex.weight = sigma_weight(cloud_, p) * vertex.cosine * ramp;
    }
  }

  const PointCloud& cloud_;
  const ScanGrid& grid_;
  const SightLines& sight_;
  const RangeSurfaceOptions& options_;
  float slope_ = 0;
  float row_step_ = 0;  ///< share of the distance [1]
  float col_step_ = 0;
  bool closed_turn_ = false;
  std::vector<std::uint8_t> full_;  ///< the square whose first cell this is has both triangles
  RangeSurface surface_;
};

}  // namespace

RangeSurface surface_of_grid(const PosedCloud& scan,
                             const SightLines& sight,
                             const RangeSurfaceOptions& options) {
  scan.grid.check(scan.cloud.size());
  return GridSurface(scan, sight, options).build();
}

}  // namespace facula
