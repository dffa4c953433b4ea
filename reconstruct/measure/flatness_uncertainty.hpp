// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/reconstruct/measure/flatness.hpp>

#include <cstddef>
#include <vector>

namespace facula {

struct FlatnessUncertaintyOptions {
  double sigma = 0;     ///< noise of points that have none of their own [m], 0 = they must have it
  int trials = 200;     ///< [1], at least 20
  unsigned seed = 1;    ///< [1]
  int num_threads = 0;  ///< 0 = all cores [1]

  void check() const;
};

/// What the noise of the points does to FLTt. A largest minus a smallest value never shrinks by
/// noise on the whole: FLTt of a noisy scan is too large, the more so the more points there are.
struct FlatnessUncertainty {
  double sigma_points = 0;  ///< the points' noise along the normal, root mean square [m]
  double total_sigma = 0;   ///< standard uncertainty of FLTt: its spread over repeated scans [m];
                           ///< up to 1.4 times too large where many points compete for the extremes
  double total_growth = 0;  ///< by how much the same noise once more would raise FLTt on average
                            ///< [m]; noise has raised the measured value by at least about that
  double floor_mean = 0;    ///< FLTt that a perfectly flat surface would show on average [m]
  double floor_p95 = 0;     ///< and in 95 of 100 scans at most [m]; a measured FLTt below it does
                            ///< not show that the surface is other than flat
};

/// By propagation of distributions (GUM supplement 1, JCGM 101:2008): every trial draws noise for
/// every point, normal and independent, along its ray where the cloud knows the sensor, and
/// measures FLTt again with a new reference plane. Throws Error when neither the points nor the
/// options have a sigma.
FlatnessUncertainty flatness_uncertainty(const PointCloud& cloud,
                                         const std::vector<std::size_t>& indices,
                                         const Flatness& flatness,
                                         const FlatnessUncertaintyOptions& options = {});

}  // namespace facula
