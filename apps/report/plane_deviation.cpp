// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/color_bar.hpp>
#include <facula/apps/report/deviation_histogram.hpp>
#include <facula/apps/report/grid_layout.hpp>
#include <facula/apps/report/legend.hpp>
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/plane_deviation.hpp>
#include <facula/apps/report/plot_axes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr Color kNoPoint{236, 238, 241};
constexpr double kMostCells = 420;  // along the longer side [1]

/// The points over the plane: place along its axes and signed distance [m].
struct Deviations {
  std::vector<Eigen::Vector2d> place;
  std::vector<float> distance;
  Eigen::AlignedBox2d box;
};

/// Mean distances over square cells of the plane.
struct DeviationGrid {
  int rows = 0;
  int cols = 0;
  double cell = 0;             // [m]
  std::vector<double> mean;    // [m], row 0 at the largest v
  std::vector<double> weight;  // points per cell
};

/// u along the points' longest direction, v so that u, v, normal are right-handed.
Eigen::Matrix<double, 2, 3> plane_axes(const std::vector<Eigen::Vector3d>& offsets,
                                       const Eigen::Vector3d& normal) {
  const Eigen::Vector3d a = normal.unitOrthogonal();
  const Eigen::Vector3d b = normal.cross(a);
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector3d& offset : offsets) {
    const Eigen::Vector2d place(offset.dot(a), offset.dot(b));
    spread += place * place.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread);
  const Eigen::Vector2d longest = solver.eigenvectors().col(1);
  Eigen::Vector3d u = (longest.x() * a + longest.y() * b).normalized();
  Eigen::Index main = 0;
  u.cwiseAbs().maxCoeff(&main);
  if (u[main] < 0) u = -u;
  Eigen::Matrix<double, 2, 3> axes;
  axes.row(0) = u.transpose();
  axes.row(1) = normal.cross(u).transpose();
  return axes;
}

Deviations deviations_of(const ExtractedPlane& plane, const PointCloud& cloud) {
  const Eigen::Vector3d normal = plane.fit.plane.normal.normalized();
  std::vector<Eigen::Vector3d> offsets;
  Deviations result;
  for (const std::size_t index : plane.indices) {
    require(index < cloud.size(),
            "the plane names point ",
            index,
            " of a cloud of ",
            cloud.size(),
            " points: draw it with the cloud it was extracted from");
    const Eigen::Vector3d point = cloud.points[index].cast<double>();
    if (!point.allFinite()) continue;
    offsets.emplace_back(point - plane.fit.centroid);
    result.distance.push_back(static_cast<float>(plane.fit.plane.signed_distance(point)));
  }
  if (offsets.empty()) return result;
  const Eigen::Matrix<double, 2, 3> axes = plane_axes(offsets, normal);
  result.place.reserve(offsets.size());
  for (const Eigen::Vector3d& offset : offsets) {
    result.place.emplace_back(axes * offset);
    result.box.extend(result.place.back());
  }
  return result;
}

/// Cells about as fine as the points lie.
double cell_size(const Deviations& deviations) {
  const Eigen::Vector2d sides = deviations.box.sizes();
  const auto count = static_cast<double>(deviations.place.size());
  const double finest = std::max(sides.maxCoeff(), 1e-9) / kMostCells;
  return std::max(1.6 * std::sqrt(sides.prod() / count), finest);
}

DeviationGrid grid_of(const Deviations& deviations) {
  DeviationGrid grid;
  grid.cell = cell_size(deviations);
  const Eigen::Vector2d sides = deviations.box.sizes();
  grid.cols = static_cast<int>(sides.x() / grid.cell) + 1;
  grid.rows = static_cast<int>(sides.y() / grid.cell) + 1;
  const std::size_t cells = static_cast<std::size_t>(grid.rows) * grid.cols;
  grid.mean.assign(cells, 0);
  grid.weight.assign(cells, 0);
  for (std::size_t i = 0; i < deviations.place.size(); ++i) {
    const Eigen::Vector2d at = (deviations.place[i] - deviations.box.min()) / grid.cell;
    const int row = grid.rows - 1 - std::min(static_cast<int>(at.y()), grid.rows - 1);
    const int col = std::min(static_cast<int>(at.x()), grid.cols - 1);
    const std::size_t cell = static_cast<std::size_t>(row) * grid.cols + col;
    grid.weight[cell] += 1;
    grid.mean[cell] += (deviations.distance[i] - grid.mean[cell]) / grid.weight[cell];
  }
  return grid;
}

Image8 map_of(const Deviations& deviations, const ColorScale& scale, double per_metre) {
  const DeviationGrid grid = grid_of(deviations);
  const GridLayout layout =
      grid_layout(grid.rows, grid.cols, {.least = 380, .most = 900, .square_cells = true});
  const Image8 cells = paint_grid(layout, [&](const CellBlock& block) {
    const std::size_t cell =
        static_cast<std::size_t>(block.row_begin) * grid.cols + block.col_begin;
    return grid.weight[cell] > 0 ? scale.at(grid.mean[cell] * per_metre) : kNoPoint;
  });
  Image8 plot = make_plot(cells.rows, cells.cols);
  paste(plot, cells, kPlotMargin.x, kPlotMargin.y);
  const LengthUnit unit = length_unit_for(deviations.box.sizes().maxCoeff());
  const Eigen::Vector2d low = deviations.box.min() * unit.per_metre;
  const Eigen::Vector2d high =
      low + Eigen::Vector2d(grid.cols, grid.rows) * grid.cell * unit.per_metre;
  const std::string in_unit = std::string(" [") + unit.name + "]";
  draw_axes(plot,
            {low.x(), high.x(), "u, along the plane" + in_unit},
            {low.y(), high.y(), "v" + in_unit});
  return beside({plot, color_bar(scale, plot.rows - kPlotMargin.height + 14)});
}

}  // namespace

Image8 plane_deviation(const ExtractedPlane& plane, const PointCloud& cloud) {
  const Deviations deviations = deviations_of(plane, cloud);
  if (deviations.place.empty()) return empty_picture("The plane has no points.");

  const ValueRange range = robust_range(deviations.distance);
  const double largest = std::max({std::abs(range.low), std::abs(range.high), 1e-7});
  const LengthUnit unit = length_unit_for(largest);
  const ColorScale scale{ColorMap::kDiverging,
                         -largest * unit.per_metre,
                         largest * unit.per_metre,
                         std::string("distance from plane [") + unit.name + "]"};
  const Image8 map = map_of(deviations, scale, unit.per_metre);
  const Image8 histogram = deviation_histogram(
      deviations.distance,
      {.largest = largest, .sigma = plane.fit.rms, .width = std::clamp(map.cols - 300, 480, 900)});
  return below({map, histogram}, 12);
}

}  // namespace facula
