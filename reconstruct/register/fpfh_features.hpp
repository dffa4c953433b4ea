// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <array>
#include <vector>

namespace facula {

constexpr int kFpfhBins = 33;  ///< three angles of 11 bins

/// A fast point feature histogram; all NaN where the point has no neighbours.
using FpfhFeature = std::array<float, kFpfhBins>;

struct FpfhOptions {
  double radius = 0;    ///< of the neighbourhood [m], above 0
  int num_threads = 0;  ///< 0 = all cores [1]

  void check() const;
};

/// The fast point feature histogram of every point (Rusu, Blodow and Beetz 2009), by PCL. `cloud`
/// needs finite points and unit normals.
std::vector<FpfhFeature> fpfh_features(const PointCloud& cloud, const FpfhOptions& options);

}  // namespace facula
