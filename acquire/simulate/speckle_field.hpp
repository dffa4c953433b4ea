// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/simulate/conditions.hpp>

#include <cstdint>

namespace facula {

/// The factor, 1 on average, by which speckle changes the laser light of each pixel: the weighted
/// sum of as many random exponential fields as the grains and patterns that a pixel averages, each
/// smoothed so that neighbouring pixels are correlated as Speckle::correlation(1) says.
Image<double> speckle_field(int rows, int cols, const Speckle& speckle, std::uint64_t seed);

/// Makes the laser's light grainy; only where there is some is a field worked out.
void apply_speckle(Image<double>& laser, const Speckle& speckle, std::uint64_t seed);

/// A seed that is the same for the same pose of the camera only: grains stay while nothing moves.
std::uint64_t speckle_seed(std::uint64_t seed, const RigidTransform& world_from_camera);

}  // namespace facula
