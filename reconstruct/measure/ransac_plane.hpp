// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/plane.hpp>

#include <optional>
#include <vector>

namespace facula {

struct RansacPlaneOptions {
  double inlier_distance = 0.01;  ///< farthest point that counts for a plane [m]
  int max_trials = 2000;          ///< [1]
};

/// The plane near most of the points, of those through three of them that lie close together
/// (Fischler and Bolles 1981, drawing locally as Myatt et al. 2002). Ends early once a better plane
/// is unlikely. Nothing when no three points span a plane.
std::optional<Plane> ransac_plane(const std::vector<Eigen::Vector3f>& points,
                                  const RansacPlaneOptions& options,
                                  Random& random);

}  // namespace facula
