// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/range_grid.hpp>
#include <facula/acquire/core/text_numbers.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <Eigen/Cholesky>

namespace facula {
namespace {

/// The number after `name` in the obj_info lines; 0 where there is none.
std::size_t info_count(const std::vector<std::string>& infos, std::string_view name) {
  for (const std::string& line : infos) {
    std::string_view rest = line;
    if (take_word(rest) != name) continue;
    return parse_number<std::size_t>(take_word(rest)).value_or(0);
  }
  return 0;
}

const PlyElement* grid_element(const std::vector<PlyElement>& elements) {
  const auto found = std::find_if(elements.begin(), elements.end(), [](const PlyElement& e) {
    return e.name == "range_grid" && !e.properties.empty() && e.properties.front().count_type;
  });
  return found == elements.end() ? nullptr : &*found;
}

/// New index of every vertex once those that are not finite are left out, or kNone.
std::vector<std::int32_t> finite_indices(const PlyElement& vertices) {
  std::vector<std::int32_t> index(vertices.rows, ScanGrid::kNone);
  std::int32_t next = 0;
  const std::array columns{vertices.find("x"), vertices.find("y"), vertices.find("z")};
  for (std::size_t row = 0; row < vertices.rows; ++row) {
    const bool finite = std::all_of(columns.begin(), columns.end(), [row](const auto* column) {
      return std::isfinite(static_cast<float>(column->values[row]));
    });
    if (finite) index[row] = next++;
  }
  return index;
}

/// The least-squares solution of rows of `coefficients` against `values`, or nothing.
template <int N>
struct LeastSquares {
  Eigen::Matrix<double, N, N> normal = Eigen::Matrix<double, N, N>::Zero();
  Eigen::Matrix<double, N, 1> right = Eigen::Matrix<double, N, 1>::Zero();
  double squares = 0;
  double count = 0;

  void add(const Eigen::Matrix<double, N, 1>& row, double value) {
    normal += row * row.transpose();
    right += row * value;
    squares += value * value;
    ++count;
  }
  Eigen::Matrix<double, N, 1> solution() const { return normal.ldlt().solve(right); }
  double rms(const Eigen::Matrix<double, N, 1>& x) const {
    return std::sqrt(std::max(0.0, squares - right.dot(x)) / count);
  }
  /// Standard deviation of the last coefficient.
  double last_sigma(const Eigen::Matrix<double, N, 1>& x) const {
    const Eigen::Matrix<double, N, 1> unit = Eigen::Matrix<double, N, 1>::Unit(N - 1);
    return rms(x) * std::sqrt(std::abs(normal.ldlt().solve(unit)[N - 1]));
  }
};

/// Calls body(row, col, point) for every cell with a point; rows and columns run from -1 to 1, so
/// that the sums below keep their digits.
template <typename Body>
void for_cells(const PointCloud& cloud, const ScanGrid& grid, const Body& body) {
  for (int col = 0; col < grid.cols; ++col) {
    for (int row = 0; row < grid.rows; ++row) {
      const std::int32_t p = grid.point[grid.index(row, col)];
      if (p == ScanGrid::kNone) continue;
      body(2.0 * row / grid.rows - 1,
           2.0 * col / grid.cols - 1,
           cloud.points[static_cast<std::size_t>(p)].cast<double>());
    }
  }
}

/// Does x follow from the column, as where a stage moves the sheet along x? Rows may be shifted by
/// half a column (`is_interlaced`).
bool x_follows_from_column(const PointCloud& cloud, const ScanGrid& grid) {
  LeastSquares<2> fit;
  for_cells(cloud, grid, [&](double, double col, const Eigen::Vector3d& p) {
    fit.add({1, col}, p.x());
  });
  if (fit.count < 3) return false;
  const Eigen::Vector2d x = fit.solution();
  const double spacing = std::abs(x[1]) * 2 / grid.cols;
  return x.allFinite() && spacing > 0 && fit.rms(x) < 0.5 * spacing;
}

/// (y, z) of the point at which the rows' lines of sight meet; nothing told when they look
/// parallel, then z is infinite.
Eigen::Vector2d meeting_point(const PointCloud& cloud, const ScanGrid& grid) {
  Eigen::Vector2d parallel(0, std::numeric_limits<double>::infinity());
  LeastSquares<4> fit;
  for_cells(cloud, grid, [&](double row, double, const Eigen::Vector3d& p) {
    fit.add({1, row, p.z(), row * p.z()}, p.y());
  });
  const Eigen::Vector4d f = fit.solution();
  if (!f.allFinite() || std::abs(f[3]) < 5 * fit.last_sigma(f)) return parallel;
  const double z = -f[1] / f[3];
  return {f[0] + f[2] * z, z};
}

}  // namespace

ScanGrid range_grid(const std::vector<PlyElement>& elements,
                    const std::vector<std::string>& infos,
                    const std::filesystem::path& path) {
  const PlyElement* cells = grid_element(elements);
  if (cells == nullptr) return {};
  const std::size_t cols = info_count(infos, "num_cols");
  const std::size_t rows = info_count(infos, "num_rows");
  constexpr std::size_t kMost = std::numeric_limits<std::int32_t>::max();
  require(cols > 0 && rows > 0 && cols <= kMost && rows <= kMost && cells->rows == rows * cols,
          "'",
          path.string(),
          "' has a range_grid of ",
          cells->rows,
          " cells where its obj_info num_rows and num_cols say ",
          rows,
          " x ",
          cols,
          "; correct the header");
  const std::vector<std::int32_t> index = finite_indices(ply_element(elements, "vertex", path));
  ScanGrid grid{static_cast<int>(rows), static_cast<int>(cols), {}};
  grid.point.assign(cells->rows, ScanGrid::kNone);
  const PlyProperty& list = cells->properties.front();
  for (std::size_t cell = 0; cell < cells->rows; ++cell) {
    const std::size_t begin = cell == 0 ? 0 : list.ends[cell - 1];
    if (list.ends[cell] == begin) continue;
    const double vertex = list.values[begin];
    require(
        list.ends[cell] == begin + 1 && vertex >= 0 && vertex < static_cast<double>(index.size()),
        "'",
        path.string(),
        "' has a range_grid cell that names vertex ",
        vertex,
        " of ",
        index.size(),
        " or more than one; write the file again");
    grid.point[grid.index(static_cast<int>(cell / cols), static_cast<int>(cell % cols))] =
        index[static_cast<std::size_t>(vertex)];
  }
  grid.check(index.size());
  return grid;
}

std::vector<Eigen::Vector3f> seen_from(const PointCloud& cloud, const ScanGrid& grid) {
  grid.check(cloud.size());
  if (!x_follows_from_column(cloud, grid)) return {};
  const Eigen::Vector2d meet = meeting_point(cloud, grid);
  std::vector<Eigen::Vector3f> origins;
  origins.reserve(cloud.size());
  for (const Eigen::Vector3f& point : cloud.points) {
    const Eigen::Vector3d p = point.cast<double>();
    Eigen::Vector3d towards = Eigen::Vector3d::UnitZ();
    if (std::isfinite(meet[1]) && meet[1] != p.z()) {
      towards = Eigen::Vector3d(0, meet[0] - p.y(), meet[1] - p.z()).normalized();
    }
    origins.emplace_back((p + towards).cast<float>());
  }
  return origins;
}

}  // namespace facula
