// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>
#include <facula/acquire/core/rigid_transform.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

using Color = std::array<std::uint8_t, 3>;  ///< red, green, blue [0..255]

/// Points with optional attributes. Every attribute is either empty or as long as `points`.
struct PointCloud {
  std::vector<Eigen::Vector3f> points;         ///< [m]
  std::vector<Eigen::Vector3f> normals;        ///< unit length [1]
  std::vector<Color> colors;                   ///< [0..255]
  std::vector<float> intensity;                ///< [0..1]
  std::vector<float> sigma;                    ///< 1 standard deviation along the ray [m]
  std::vector<Eigen::Vector3f> sensor_origin;  ///< where the point was seen from [m]

  std::size_t size() const { return points.size(); }
  bool empty() const { return points.empty(); }

  /// Throws Error when an attribute is neither empty nor as long as `points`.
  void check() const;
};

/// The cloud in another frame: points, normals and origins are carried over, the rest is kept.
PointCloud transformed(const PointCloud& cloud, const RigidTransform& target_from_source);

/// The points at `indices`, with their attributes, in that order.
PointCloud selected(const PointCloud& cloud, const std::vector<std::size_t>& indices);

/// Adds the points of `more`; an attribute that either side lacks is dropped.
void append(PointCloud& cloud, const PointCloud& more);

/// The valid cells of a scan, column by column, in the scan frame, with intensity, sigma and the
/// column's sensor origin. `cells`, when given, receives the cell index of every point.
PointCloud cloud_from_scan(const PolarScan& scan, std::vector<std::size_t>* cells = nullptr);

}  // namespace facula
