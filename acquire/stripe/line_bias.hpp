// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>

namespace facula {

/// Root mean square of bias(place) [px] over places -1/2 to 1/2 px beside a pixel's middle: what a
/// line that lies anywhere in the pixel suffers. By 8 midpoints.
template <typename Bias>
double rms_bias(const Bias& bias) {
  constexpr int kPlaces = 8;
  double sum = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double b = bias((i + 0.5) / kPlaces - 0.5);
    sum += b * b;
  }
  return std::sqrt(sum / kPlaces);
}

}  // namespace facula
