// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/simulate/conditions.hpp>
#include <facula/acquire/simulate/ray_table.hpp>

#include <vector>

namespace facula {

/// Weights of a blur, from the middle outwards: the discrete Gaussian e^-t I_n(t), t = sigma^2,
/// whose variance is t at every width (Lindeberg 1990). Their sum over both sides is 1.
std::vector<double> blur_weights(double sigma);

/// Spreads the light of an image as the lens does: point spread and glare. Beyond the border the
/// image goes on as it ends.
void spread_light(Image<double>& image, const Lens& lens);

/// Darkens an image towards its corners by cos^vignetting of the angle off the axis.
void vignette(Image<double>& image, const RayTable& rays, double vignetting);

}  // namespace facula
