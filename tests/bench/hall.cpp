// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/tests/bench/hall.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace facula {
namespace {

struct Box {
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

const Box kHall{{0, 0, 0}, {60, 40, 12}};

std::vector<Box> columns() {
  std::vector<Box> boxes;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 3; ++j) {
      const Eigen::Vector3d foot(10.0 + 10 * i, 10.0 + 10 * j, 0);
      boxes.push_back({foot - Eigen::Vector3d(0.4, 0.4, 0), foot + Eigen::Vector3d(0.4, 0.4, 12)});
    }
  }
  return boxes;
}

/// Where a ray enters a box and leaves it [m]; entry above exit where it misses.
std::pair<double, double> cross(const Box& box,
                                const Eigen::Vector3d& eye,
                                const Eigen::Vector3d& way) {
  const Eigen::Array3d a = (box.low - eye).array() / way.array();
  const Eigen::Array3d b = (box.high - eye).array() / way.array();
  return {a.min(b).maxCoeff(), a.max(b).minCoeff()};
}

double range_in_hall(const std::vector<Box>& boxes,
                     const Eigen::Vector3d& eye,
                     const Eigen::Vector3d& way) {
  double range = cross(kHall, eye, way).second;
  for (const Box& box : boxes) {
    const auto [enter, leave] = cross(box, eye, way);
    if (enter > 0 && enter < leave) range = std::min(range, enter);
  }
  return range;
}

double distance_to_box(const Box& box, const Eigen::Vector3d& p) {
  const Eigen::Vector3d out = (box.low - p).cwiseMax(p - box.high);
  const double outside = out.cwiseMax(0.0).norm();
  return outside > 0 ? outside : -out.maxCoeff();
}

}  // namespace

PosedCloud hall_scan(std::size_t station, const HallOptions& options) {
  const std::vector<Box> boxes = columns();
  const int across = (options.stations + 1) / 2;
  const auto place = static_cast<int>(station);
  const Eigen::Vector3d eye(60.0 * (place / 2 + 0.5) / across, place % 2 == 0 ? 13.3 : 26.7, 1.7);
  PosedCloud scan;
  scan.name = "station " + std::to_string(station + 1);
  scan.world_from_scan.translation = eye;
  scan.grid.rows = options.rows;
  scan.grid.cols = options.cols;
  const std::size_t cells =
      static_cast<std::size_t>(options.rows) * static_cast<std::size_t>(options.cols);
  scan.grid.point.resize(cells);
  scan.cloud.points.resize(cells);
  scan.cloud.sensor_origin.assign(cells, Eigen::Vector3f::Zero());
  scan.cloud.sigma.assign(cells, static_cast<float>(options.sigma));
  const auto shoot = [&](std::size_t begin, std::size_t end) {
    for (std::size_t col = begin; col < end; ++col) {
      Random random(station + 1, col);
      const double yaw = 2 * M_PI * (static_cast<double>(col) + 0.5) / options.cols;
      for (int row = 0; row < options.rows; ++row) {
        const double pitch = (-60 + 148.0 * row / (options.rows - 1)) * M_PI / 180;
        const Eigen::Vector3d way(
            std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch));
        const double range = range_in_hall(boxes, eye, way) + options.sigma * random.normal();
        const std::size_t cell = scan.grid.index(row, static_cast<int>(col));
        scan.grid.point[cell] = static_cast<std::int32_t>(cell);
        scan.cloud.points[cell] = (range * way).cast<float>();
      }
    }
  };
  parallel_for(static_cast<std::size_t>(options.cols),
               shoot,
               {.num_threads = options.num_threads, .chunk = 32});
  return scan;
}

double distance_to_hall(const Eigen::Vector3d& point) {
  static const std::vector<Box> all = columns();
  double nearest = distance_to_box(kHall, point);
  for (const Box& box : all) nearest = std::min(nearest, distance_to_box(box, point));
  return nearest;
}

}  // namespace facula
