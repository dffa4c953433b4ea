// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <cmath>

namespace facula {

/// Whether a point's sigma [m] says anything. Files and grids hold 0 where nobody stated one, so 0,
/// like what is not finite, means unknown and never perfect: it gives a point no weight of its own.
inline bool is_known_sigma(double sigma) {
  return sigma > 0 && std::isfinite(sigma);
}

/// Whether every finite point of the cloud knows its sigma. Only then may sigmas weigh the points
/// against each other; where one is unknown all count alike, as in a cloud without sigmas.
inline bool knows_sigma(const PointCloud& cloud) {
  if (cloud.sigma.empty()) return false;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.points[i].allFinite() && !is_known_sigma(cloud.sigma[i])) return false;
  }
  return true;
}

}  // namespace facula
