// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/measure/width.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace facula {

struct FlatnessOptions {
  bool minimum_zone = true;  ///< also seek the minimum zone
  int num_threads = 0;       ///< 0 = all cores [1]
};

/// The minimum zone: the two parallel planes nearest each other with all points between them.
struct MinimumZone {
  double total = 0;                        ///< their distance, FLTt after the minimum zone [m]
  Plane plane;                             ///< halfway between them; normal as the reference's
  std::vector<std::size_t> low_contacts;   ///< points on the plane behind, indices of the cloud
  std::vector<std::size_t> high_contacts;  ///< and on the one in front
};

/// Flatness after ISO 12781-1: deviations of all points from the least-squares reference plane.
struct Flatness {
  Plane reference;  ///< every point counts the same; normal towards the sensor where the cloud
                    ///< knows it, else so that distance >= 0
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< [m]
  std::size_t points = 0;                              ///< measured; not finite ones left out [1]
  double total = 0;             ///< FLTt: largest minus smallest deviation [m]
  double peak = 0;              ///< FLTp: largest deviation [m]
  double valley = 0;            ///< FLTv: size of the smallest deviation [m]
  double root_mean_square = 0;  ///< FLTq: over n [m]
  std::size_t peak_point = 0;   ///< index of the cloud
  std::size_t valley_point = 0;
  std::optional<MinimumZone> minimum_zone;
};

/// Of the points at `indices`. Throws Error for fewer than three finite points or points on one
/// line.
Flatness measure_flatness(const PointCloud& cloud,
                          const std::vector<std::size_t>& indices,
                          const FlatnessOptions& options = {});

/// Of all points.
Flatness measure_flatness(const PointCloud& cloud, const FlatnessOptions& options = {});

}  // namespace facula
