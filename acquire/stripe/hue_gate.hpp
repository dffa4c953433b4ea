// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <string>

namespace facula {

/// Colour of the laser's light, where candidates are tested for it.
enum class LaserHue {
  kAny,    ///< no test
  kRed,    ///< 630 to 680 nm
  kGreen,  ///< 510 to 540 nm
  kBlue    ///< 405 to 470 nm
};

/// "any", "red", "green" or "blue".
LaserHue hue_from_name(const std::string& name);
std::string to_string(LaserHue hue);

/// Where a candidate lies in a frame.
struct StripePlace {
  int row = 0;              ///< of the signal: image column where `transposed` [px]
  float position = 0;       ///< [px]
  float width = 0;          ///< standard deviation of the profile [px]
  bool transposed = false;  ///< the stripe runs per column
};

/// The share of pure laser colour in the light that makes a candidate stand out. A lamp, a white
/// highlight and a laser line may all be clipped to white in the middle, but the light that was
/// added beside the middle tells them apart (source A): there, and in whatever of the core is not
/// clipped, the mean of (own colour - brighter of the other two) over the surroundings is divided
/// by the mean of the own colour over the surroundings. About 1 for a laser (0.5 and up as cameras
/// see it), about 0 for white light. It asks for *added* light, so that an object of the laser's
/// colour does not pass by its own colour and a white highlight on it fails. Where the own colour
/// is clipped in the surroundings already nothing can be told: 0. Surroundings are the darker side.
/// What it cannot tell from the line is a thing of the laser's colour and of the line's width.
/// `background`, when not empty, is taken off first. A grey frame has no colours: 1.
double hue_share(ImageView8 frame, ImageView8 background, const StripePlace& place, LaserHue hue);

}  // namespace facula
