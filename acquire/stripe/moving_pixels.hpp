// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

namespace facula {

/// The mean of two frames, rounded to whole DN. Where either is clipped the mean is too (255), so
/// that a clipped core stays known as one. Throws Error when they differ in size or channels.
Image8 mean_of(ImageView8 first, ImageView8 second);

/// Where two frames of the same light differ by more than noise, flicker aside: a grey image, 255
/// where something moved (or the lamp beside it changed), 0 elsewhere. Compared are means over
/// 3 x 3 px of the brightest colour difference, against 6 times their noise (by the median of the
/// picture's differences) plus 3 % of the brightness, which photon noise and a residue of flicker
/// may make. A pixel of either light that is not the same before and after is not known in between.
/// Throws Error when the frames differ in size or channels.
Image8 moving_pixels(ImageView8 first, ImageView8 second);

}  // namespace facula
