// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/random.hpp>
#include <facula/acquire/rig/rig.hpp>

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A surface in the camera frame: where the ray from the camera's centre along a direction meets
/// it first; none where it does not.
using SurfaceHit = std::function<std::optional<Eigen::Vector3d>(const Eigen::Vector3d&)>;

/// Points x with normal . x = distance.
SurfaceHit plane_surface(const Eigen::Vector3d& normal, double distance);

/// Where the stripe of a sheet lies in an image row (x), or for a stripe per column in an image
/// column (y): the place whose ray meets the surface on the sheet, found by halving an interval of
/// the line. The cone of a bowed sheet is
/// written out here a second time; the projection alone is shared with what is being tested. None
/// where the line shows no stripe.
std::optional<double> exact_position(const Rig& rig,
                                     std::size_t laser,
                                     const SurfaceHit& surface,
                                     int line);

/// The pixel of a position in a line.
Eigen::Vector2d pixel_of(const Rig& rig, double position, int line);

/// exact_position() of every line of the image, NaN where there is none.
std::vector<double> exact_positions(const Rig& rig, std::size_t laser, const SurfaceHit& surface);

/// Adds normal noise of `sigma` [px] to every position.
std::vector<double> noisy(const std::vector<double>& positions, double sigma, Random& random);

/// Mean of `count` noisy copies.
std::vector<double> noisy_mean(const std::vector<double>& positions,
                               double sigma,
                               int count,
                               Random& random);

}  // namespace facula
