// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/grid_links.hpp>
#include <facula/reconstruct/filter/line_of_sight.hpp>

#include <cmath>

namespace facula {
namespace {

struct LinkJudge {
  const PointCloud& cloud;
  double tangent;  ///< of the steepest incidence that joins
  bool has_noise;  ///< the points know their sigma

  bool joins(std::size_t a, std::size_t b) const {
    const Eigen::Vector3f step = cloud.points[b] - cloud.points[a];
    const double along = step.dot(towards_sensor(cloud, a).stableNormalized());
    const double across = std::sqrt(std::max(0.0, double(step.squaredNorm()) - along * along));
    if (std::abs(along) <= tangent * across) return true;
    return has_noise && std::abs(along) <= 4 * std::hypot(cloud.sigma[a], cloud.sigma[b]);
  }

  float distance(std::size_t a, std::size_t b) const {
    return (cloud.points[b] - cloud.points[a]).norm();
  }
};

double median_or_zero(std::vector<float> values) {
  return values.empty() ? 0.0 : double(median(values));
}

}  // namespace

GridLinks grid_links(const PointCloud& cloud,
                     const ScanGrid& grid,
                     double max_incidence,
                     int num_threads) {
  GridLinks links;
  links.joined.assign(grid.point.size(), 0);
  const LinkJudge judge{cloud, std::tan(max_incidence), knows_sigma(cloud)};
  const auto point_at = [&](int row, int col) {
    const bool inside = row < grid.rows && col < grid.cols;
    return inside ? grid.point[grid.index(row, col)] : ScanGrid::kNone;
  };
  const auto join = [&](std::size_t first, std::size_t last) {
    for (int col = int(first); col < int(last); ++col) {
      for (int row = 0; row < grid.rows; ++row) {
        const std::int32_t here = point_at(row, col);
        if (here == ScanGrid::kNone) continue;
        const std::int32_t down = point_at(row + 1, col);
        const std::int32_t right = point_at(row, col + 1);
        std::uint8_t& joined = links.joined[grid.index(row, col)];
        const auto p = static_cast<std::size_t>(here);
        if (down >= 0 && judge.joins(p, std::size_t(down))) joined |= GridLinks::kDown;
        if (right >= 0 && judge.joins(p, std::size_t(right))) joined |= GridLinks::kRight;
      }
    }
  };
  parallel_for(std::size_t(grid.cols), join, {.num_threads = num_threads, .chunk = 8});
  // Every so many cells: a few thousand distances give the median as well as all of them.
  const std::size_t stride = 1 + grid.point.size() / 20000;
  std::vector<float> down;
  std::vector<float> right;
  for (std::size_t cell = 0; cell < grid.point.size(); cell += stride) {
    const auto p = static_cast<std::size_t>(grid.point[cell]);
    const auto next = [&](std::size_t step) { return std::size_t(grid.point[cell + step]); };
    if ((links.joined[cell] & GridLinks::kDown) != 0) down.push_back(judge.distance(p, next(1)));
    if ((links.joined[cell] & GridLinks::kRight) != 0) {
      right.push_back(judge.distance(p, next(std::size_t(grid.rows))));
    }
  }
  links.row_spacing = median_or_zero(std::move(down));
  links.col_spacing = median_or_zero(std::move(right));
  return links;
}

}  // namespace facula
