// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/color_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace facula {
namespace {

// Nine samples of viridis (van der Walt and Smith 2015, CC0), evenly spaced.
constexpr std::array<Color, 9> kViridisSamples{{{68, 1, 84},
                                                {71, 45, 123},
                                                {59, 82, 139},
                                                {44, 114, 142},
                                                {33, 145, 140},
                                                {40, 174, 128},
                                                {94, 201, 98},
                                                {173, 220, 48},
                                                {253, 231, 37}}};

// Blue and red of equal lightness at equal distance from white.
constexpr std::array<Color, 7> kDivergingSamples{{{22, 62, 148},
                                                  {74, 130, 204},
                                                  {172, 205, 235},
                                                  {247, 247, 247},
                                                  {246, 192, 168},
                                                  {218, 104, 82},
                                                  {150, 20, 40}}};

Color interpolated(std::span<const Color> samples, double t) {
  const double position = std::clamp(t, 0.0, 1.0) * static_cast<double>(samples.size() - 1);
  const auto first = std::min(static_cast<std::size_t>(position), samples.size() - 2);
  const double share = position - static_cast<double>(first);
  Color color{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double value = (1 - share) * samples[first][k] + share * samples[first + 1][k];
    color[k] = static_cast<std::uint8_t>(std::lround(value));
  }
  return color;
}

}  // namespace

Color color_at(ColorMap map, double t) {
  if (std::isnan(t)) return kNoDataColor;
  if (map == ColorMap::kDiverging) return interpolated(kDivergingSamples, t);
  return interpolated(kViridisSamples, t);
}

Color lit(Color color, double light) {
  for (std::uint8_t& part : color) {
    part = static_cast<std::uint8_t>(std::lround(std::clamp(part * light, 0.0, 255.0)));
  }
  return color;
}

}  // namespace facula
