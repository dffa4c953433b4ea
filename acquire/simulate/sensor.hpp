// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <cstdint>

namespace facula {

/// What the sensor makes of the light on it [DN]: shot and read noise, black level, 8 bits.
/// `exposure` numbers the noise.
Image8 sensed(const Image<double>& light, const SimulateOptions& options, std::uint64_t exposure);

}  // namespace facula
