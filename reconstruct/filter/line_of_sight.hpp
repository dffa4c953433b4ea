// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <cstddef>

namespace facula {

/// From a point to where it was seen from [m]: to its sensor origin, or to the frame's origin where
/// the cloud has none.
inline Eigen::Vector3f towards_sensor(const PointCloud& cloud, std::size_t i) {
  if (cloud.sensor_origin.empty()) return -cloud.points[i];
  return cloud.sensor_origin[i] - cloud.points[i];
}

}  // namespace facula
