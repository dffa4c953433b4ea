// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <string>

namespace facula {

/// How a background is brought to the brightness of the lit frame before it is taken off. Lamps on
/// the mains pulse at 100 or 120 Hz: two frames see them at different phases, and with a rolling
/// shutter every row does.
enum class Flicker {
  kIgnore,  ///< taken off as it is
  kFrame,   ///< one gain and offset per colour for the whole frame
  kRows     ///< and a gain per row on top
};

/// "ignore", "frame" or "rows".
Flicker flicker_from_name(const std::string& name);
std::string to_string(Flicker flicker);

/// The background as bright as the frame's own: gain * background + offset, fitted by least squares
/// to the pixels that follow it (the stripe, what moves and what is clipped in either are trimmed
/// off, 3 standard deviations by the median), then, with kRows, times 1 + g of the row, fitted
/// likewise. Both are drawn towards no change where the background has nothing to tell by (a gain
/// by as much as noise in a flat background could feign). Fails where more than half of the picture
/// changed. Rounded to whole DN, which adds 0.29 DN of noise. Throws Error when the two differ in
/// size or channels.
Image8 match_background(ImageView8 frame, ImageView8 background, Flicker flicker);

}  // namespace facula
