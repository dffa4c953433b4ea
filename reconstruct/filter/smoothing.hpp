// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <cstddef>

namespace facula {

struct SmoothingOptions {
  double radius = 0;  ///< half width (1 sigma) of the Gaussian weights [m], above 0
  int order = 2;      ///< of the local surface: 1 = plane, 2 = paraboloid [1]
  /// Of points that do not know their sigma [m]; 0 = where any does not, from how well the surfaces
  /// fit, and all points count alike.
  double default_sigma = 0;
  double max_misfit = 2;  ///< reduced chi-square of a surface that is moved onto [1]
  int num_threads = 0;    ///< 0 = all cores [1]

  void check() const;
};

struct SmoothedCloud {
  PointCloud cloud;               ///< moved points, their normals and their new sigmas
  std::size_t moved = 0;          ///< points with enough neighbours for a local surface [1]
  double median_move = 0;         ///< of the moved points, along the normal [m]
  double median_sigma_ratio = 0;  ///< new sigma over the old one [1]
};

/// Moving least squares (Levin 1998; Alexa et al. 2003): through the neighbours of every point,
/// weighted by a Gaussian of their distance over sigma^2, a surface z(u, v) of the given order is
/// fitted over their plane, and the point moves along that plane's normal onto it. The new height
/// is a sum a_i z_i, hence its variance the sum of a_i^2 sigma_i^2 (sigma taken along the normal):
/// that is the point's new sigma, along the ray again. It does not hold what the surface's bending
/// between the neighbours adds. Points with fewer than twice as many neighbours (within 2.5 radii)
/// as coefficients, points whose neighbours lie along a line (a single stripe: choose a larger
/// radius), points whose surface misses its neighbours by more than their sigmas explain (an edge
/// or a bend within the radius), and points that are not finite, stay as they are. Throws Error
/// when the radius takes in thousands of neighbours.
SmoothedCloud smooth(const PointCloud& cloud, const SmoothingOptions& options);

}  // namespace facula
