// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>

namespace facula {

/// A hall of 60 x 40 x 12 m with 15 square columns of 0.8 m, in closed form.
struct HallOptions {
  int stations = 8;     ///< where the scanner stood [1]
  int rows = 1000;      ///< directions from 60 deg below to 88 deg above the horizon [1]
  int cols = 2500;      ///< directions of a full turn [1]
  double sigma = 2e-3;  ///< noise along the ray [m]
  int num_threads = 0;  ///< 0 = all cores [1]
};

/// The scan of one station: grid, sensor origin, sigma and pose; the same every time.
PosedCloud hall_scan(std::size_t station, const HallOptions& options);

/// How far a point lies from the nearest wall, floor, ceiling or column [m].
double distance_to_hall(const Eigen::Vector3d& point);

}  // namespace facula
