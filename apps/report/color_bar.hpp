// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/report/color_map.hpp>
#include <facula/apps/report/drawing.hpp>

#include <string>
#include <vector>

namespace facula {

/// What the colours of a picture mean.
struct ColorScale {
  ColorMap map = ColorMap::kViridis;
  double low = 0;     ///< value of the first colour, in the unit of the label
  double high = 1;    ///< value of the last colour; values beyond the ends take the end's colour
  std::string label;  ///< quantity and unit, "distance [mm]"

  Color at(double value) const { return color_at(map, (value - low) / (high - low)); }
};

/// The scale as a picture `height` px high (at least 60): label, bar, ticks with numbers.
Image8 color_bar(const ColorScale& scale, int height);

/// Ends of a colour scale that a few outliers do not stretch: the values below which `share` and
/// 1 - share of the values lie. Equal ends are moved apart. {0, 1} when no value is finite.
struct ValueRange {
  double low = 0;
  double high = 1;
};
ValueRange robust_range(std::vector<float> values, double share = 0.005);

}  // namespace facula
