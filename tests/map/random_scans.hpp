// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/random.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/octree_file.hpp>

#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace facula {

/// A scan in its own frame: points in a box of 4 x 3 x 2 m about the scanner, which stands still.
inline PointCloud random_scan(std::uint64_t seed, std::size_t points) {
  Random random(seed);
  PointCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    cloud.points.emplace_back(static_cast<float>(random.uniform() * 4 - 2),
                              static_cast<float>(random.uniform() * 3 - 1.5),
                              static_cast<float>(random.uniform() * 2 - 1));
    cloud.sensor_origin.emplace_back(0.01F, 0.02F, 0.03F);
  }
  return cloud;
}

/// Somewhere in a hall of 10 x 10 x 1 m, turned about z.
inline RigidTransform random_pose(Random& random) {
  RigidTransform pose;
  pose.translation = {random.uniform() * 10, random.uniform() * 10, random.uniform()};
  pose.rotation = Eigen::AngleAxisd(random.uniform() * 6.28, Eigen::Vector3d::UnitZ());
  return pose;
}

/// Every value of a map in OctoMap's order.
inline std::string ot_bytes(const OccupancyMap& map) {
  std::ostringstream bytes;
  write_ot(bytes, map.bricks(), map.resolution());
  return bytes.str();
}

/// Holds two maps equal, cell by cell and to the last bit.
inline testing::AssertionResult is_same_map(const OccupancyMap& a, const OccupancyMap& b) {
  if (a.resolution() != b.resolution()) return testing::AssertionFailure() << "other cells";
  const auto ours = a.bricks().sorted();
  const auto theirs = b.bricks().sorted();
  if (ours.size() != theirs.size()) {
    return testing::AssertionFailure() << ours.size() << " and " << theirs.size() << " bricks";
  }
  for (std::size_t i = 0; i < ours.size(); ++i) {
    LogOddsBrick::Values x{};
    LogOddsBrick::Values y{};
    const bool same = ours[i]->code == theirs[i]->code &&
                      ours[i]->brick.read(x) == theirs[i]->brick.read(y) && x == y;
    if (!same) return testing::AssertionFailure() << "brick " << i << " differs";
  }
  return testing::AssertionSuccess();
}

}  // namespace facula
