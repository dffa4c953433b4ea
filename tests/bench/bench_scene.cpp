// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/tests/bench/bench_scene.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

namespace facula {
namespace {

struct Box {
  Eigen::Vector3d min;
  Eigen::Vector3d max;
};

const Box kRoom{{-4, -3, 0}, {4, 3, 3}};
const std::array<Box, 4> kBoxes = {{{{-3.5, -2.5, 0}, {-2.5, -1.0, 0.9}},
                                    {{2.0, 1.5, 0}, {3.5, 2.5, 1.8}},
                                    {{-1.0, 2.0, 0}, {0.5, 2.8, 0.5}},
                                    {{1.0, -2.6, 0}, {1.6, -2.0, 2.2}}}};

/// Ray parameters at which the line enters and leaves a box (the slab method).
std::array<double, 2> crossings(const Box& box,
                                const Eigen::Vector3d& origin,
                                const Eigen::Vector3d& direction) {
  const Eigen::Array3d a = (box.min - origin).array() / direction.array();
  const Eigen::Array3d b = (box.max - origin).array() / direction.array();
  return {a.min(b).maxCoeff(), a.max(b).minCoeff()};
}

double range_to_room(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double range = crossings(kRoom, origin, direction)[1];
  for (const Box& box : kBoxes) {
    const auto [in, out] = crossings(box, origin, direction);
    if (in < out && in > 0) range = std::min(range, in);
  }
  return range;
}

RigidTransform room_from_head(int stand) {
  constexpr double kPlaces[3][4] = {{0, 0, 1.2, 0.1}, {-2, 1, 1.3, 0.9}, {2, -1, 1.4, -0.6}};
  const double* place = kPlaces[stand];
  RigidTransform pose;
  pose.rotation = Eigen::AngleAxisd(place[3], Eigen::Vector3d::UnitZ());
  pose.translation = {place[0], place[1], place[2]};
  return pose;
}

}  // namespace

bool small_run() {
  return std::getenv("FACULA_BENCH_SMALL") != nullptr;
}

PolarScan room_scan(int stand, const RoomGrid& grid) {
  const int rows = small_run() ? grid.rows / 10 : grid.rows;
  const int cols = small_run() ? grid.cols / 10 : grid.cols;
  PolarScan scan = PolarScan::empty(rows, cols);
  scan.world_from_scan = room_from_head(stand);
  Random random(1, static_cast<std::uint64_t>(stand));
  for (int col = 0; col < cols; ++col) {
    const double yaw = std::numbers::pi * (2.0 * (col + 0.5) / cols - 1);
    scan.axis_position[static_cast<std::size_t>(col)] = yaw;
    for (int row = 0; row < rows; ++row) {
      const double pitch = (0.5 - (row + 0.5) / rows) * 2.4;
      const Eigen::Vector3d direction(
          std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch));
      const double range = range_to_room(scan.world_from_scan.translation,
                                         scan.world_from_scan.rotation * direction);
      scan.set(scan.index(row, col), direction * (range + 0.002 * random.normal()), 0.5F, 0.002F);
    }
  }
  return scan;
}

PointCloud room_cloud(int stand, const RoomGrid& grid) {
  const PolarScan scan = room_scan(stand, grid);
  return transformed(cloud_from_scan(scan), scan.world_from_scan);
}

std::vector<Image8> stripe_frames(int rows, int cols, int count) {
  std::vector<Image8> frames;
  for (int f = 0; f < count; ++f) {
    Random random(2, static_cast<std::uint64_t>(f));
    Image8& frame = frames.emplace_back(rows, cols);
    for (int r = 0; r < rows; ++r) {
      const double middle = cols * (0.3 + 0.05 * f + 0.1 * std::sin(6.0 * r / rows));
      for (int c = 0; c < cols; ++c) {
        const double u = (c - middle) / 2.0;
        const double value = 8 + 120 * std::exp(-0.5 * u * u) + 2 * random.normal();
        frame.row(r)[c] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
      }
    }
  }
  return frames;
}

}  // namespace facula
