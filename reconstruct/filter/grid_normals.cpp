// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/grid_links.hpp>
#include <facula/reconstruct/filter/grid_normals.hpp>
#include <facula/reconstruct/filter/line_of_sight.hpp>
#include <facula/reconstruct/filter/plane_of_points.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace facula {
namespace {

constexpr int kMaxHalf = 12;  ///< of the window, in cells

/// Half the window's width in rows and columns [cells].
struct Window {
  int rows = 1;
  int cols = 1;
};

/// About `neighbours` cells, about square on the surface.
Window window_for(const GridLinks& links, const ScanGrid& grid, int neighbours) {
  const double cells = neighbours + 1;
  const bool known = links.row_spacing > 0 && links.col_spacing > 0;
  const double ratio = known ? links.col_spacing / links.row_spacing : 1;  // rows per column
  const auto half = [](double width, int size) {
    const int wanted = static_cast<int>(std::lround((width - 1) / 2));
    return size > 1 ? std::clamp(wanted, 1, kMaxHalf) : 0;
  };
  Window window;
  window.cols = half(std::sqrt(cells / ratio), grid.cols);
  window.rows = half(cells / (2 * window.cols + 1), grid.rows);
  return window;
}

/// Walks the window around a cell outwards and tells which cells hang together with it.
class WindowWalk {
 public:
  WindowWalk(const ScanGrid& grid, const GridLinks& links, const Window& window)
      : grid_(grid), links_(links), window_(window) {}

  /// Calls body(point) for every cell joined to (row, col) by cells that lie between, itself first.
  template <typename Body>
  void visit(int row, int col, const Body& body) const {
    body(point(row, col));
    std::array<bool, kMaxHalf + 1> column{};
    for (const int right : {1, -1}) {
      for (const int down : {1, -1}) {
        column.fill(false);
        column[0] = true;
        // The axes of the window belong to one quadrant each.
        for (int c = 0; c <= window_.cols; ++c) {
          for (int r = 0; r <= window_.rows; ++r) {
            const int at_row = row + down * r;
            const int at_col = col + right * c;
            const bool centre = r == 0 && c == 0;
            const bool from_col =
                c > 0 && column[std::size_t(r)] && joined_col(at_row, at_col, right);
            const bool from_row =
                r > 0 && column[std::size_t(r - 1)] && joined_row(at_row, at_col, down);
            column[std::size_t(r)] = centre || from_col || from_row;
            const bool shared = (r == 0 && down < 0) || (c == 0 && right < 0);
            if (column[std::size_t(r)] && !centre && !shared) body(point(at_row, at_col));
          }
        }
      }
    }
  }

 private:
  std::int32_t point(int row, int col) const { return grid_.point[grid_.index(row, col)]; }

  /// Is the cell joined to the one it was reached from by a step of `down` rows?
  bool joined_row(int row, int col, int down) const {
    if (row < 0 || row >= grid_.rows || col < 0 || col >= grid_.cols) return false;
    const int upper = down > 0 ? row - 1 : row;
    return (links_.joined[grid_.index(upper, col)] & GridLinks::kDown) != 0;
  }
  bool joined_col(int row, int col, int right) const {
    if (row < 0 || row >= grid_.rows || col < 0 || col >= grid_.cols) return false;
    const int left = right > 0 ? col - 1 : col;
    return (links_.joined[grid_.index(row, left)] & GridLinks::kRight) != 0;
  }

  const ScanGrid& grid_;
  const GridLinks& links_;
  Window window_;
};

}  // namespace

void GridNormalOptions::check() const {
  require(neighbours >= 4, "neighbours is ", neighbours, "; a plane in a grid needs at least 4");
  require(max_incidence > 0 && max_incidence < std::numbers::pi / 2,
          "max_incidence is ",
          max_incidence,
          " rad; give an angle above 0 and below pi/2");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

std::vector<Eigen::Vector3f> grid_normals(const PointCloud& cloud,
                                          const ScanGrid& grid,
                                          const GridNormalOptions& options) {
  options.check();
  cloud.check();
  grid.check(cloud.size());
  std::vector<Eigen::Vector3f> normals(cloud.size(), Eigen::Vector3f::Zero());
  const GridLinks links = grid_links(cloud, grid, options.max_incidence, options.num_threads);
  const WindowWalk walk(grid, links, window_for(links, grid, options.neighbours));
  const auto normal_of_cell = [&](int row, int col) {
    const auto p = static_cast<std::size_t>(grid.point[grid.index(row, col)]);
    PlaneOfPoints plane(cloud.points[p]);
    walk.visit(row, col, [&](std::int32_t q) { plane.add(cloud.points[std::size_t(q)]); });
    normals[p] = plane.normal_towards(towards_sensor(cloud, p));
  };
  const auto estimate = [&](std::size_t first, std::size_t last) {
    for (int col = int(first); col < int(last); ++col) {
      for (int row = 0; row < grid.rows; ++row) {
        if (grid.point[grid.index(row, col)] != ScanGrid::kNone) normal_of_cell(row, col);
      }
    }
  };
  parallel_for(std::size_t(grid.cols), estimate, {.num_threads = options.num_threads, .chunk = 4});
  return normals;
}

}  // namespace facula
