// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/hue_gate.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace facula {
namespace {

constexpr int kFull = 250;  // compression leaves clipped surfaces a few DN below 255 [DN]

constexpr double kGlow = 2.5;      // widths' worth of glow about an overexposed line [1]
constexpr double kLeastLight = 2;  // added light that has a colour at all [DN]

constexpr std::array<std::pair<LaserHue, const char*>, 4> kNames = {{
    {LaserHue::kAny, "any"},
    {LaserHue::kRed, "red"},
    {LaserHue::kGreen, "green"},
    {LaserHue::kBlue, "blue"},
}};

/// Index of the own colour in a blue-green-red pixel.
int own_channel(LaserHue hue) {
  if (hue == LaserHue::kBlue) return 0;
  return hue == LaserHue::kGreen ? 1 : 2;
}

/// One pixel of a frame along the stripe's row, background taken off.
struct ColourPixel {
  int own = 0;        ///< [DN]
  int excess = 0;     ///< own - brighter of the others [DN]
  bool full = false;  ///< own colour at or next to its end, where light adds nothing
};

class ColourRow {
 public:
  ColourRow(ImageView8 frame, ImageView8 background, const StripePlace& place, LaserHue hue)
      : frame_(frame), background_(background), place_(place), own_(own_channel(hue)) {}

  int size() const { return place_.transposed ? frame_.rows : frame_.cols; }

  ColourPixel at(int c) const {
    const std::uint8_t* lit = pixel(frame_, c);
    std::array<int, 3> value = {lit[0], lit[1], lit[2]};
    if (!background_.empty()) {
      const std::uint8_t* dark = pixel(background_, c);
      for (std::size_t k = 0; k < 3; ++k) value[k] -= dark[k];
    }
    const auto own = static_cast<std::size_t>(own_);
    const int others = std::max(value[(own + 1) % 3], value[(own + 2) % 3]);
    return {value[own], value[own] - others, lit[own] >= kFull};
  }

 private:
  const std::uint8_t* pixel(ImageView8 image, int c) const {
    return place_.transposed ? image.row(c) + 3 * place_.row : image.row(place_.row) + 3 * c;
  }

  ImageView8 frame_;
  ImageView8 background_;
  StripePlace place_;
  int own_;
};

/// Means over the pixels of some columns that can be believed.
struct ColourMean {
  double own = 0;
  double excess = 0;
  int count = 0;
  int full = 0;

  void add(const ColourPixel& pixel) {
    own += pixel.own;
    excess += pixel.excess;
    ++count;
    full += pixel.full ? 1 : 0;
  }
  double mean_own() const { return own / count; }
  double mean_excess() const { return excess / count; }
};

/// The share on one side of the middle (`side` -1 or 1): light within 3 `reach`, level from 5 to 8.
double share_beside(const ColourRow& row, double middle, int side, double reach) {
  ColourMean light;
  ColourMean level;
  const int steps = static_cast<int>(std::ceil(8 * reach));
  const int start = static_cast<int>(std::lround(middle));
  for (int i = 0; i <= steps; ++i) {
    const int c = start + side * i;
    if (c < 0 || c >= row.size()) break;
    const ColourPixel pixel = row.at(c);
    const double off = std::abs(c - middle);
    if (off > 5 * reach) level.add(pixel);
    if (off <= 3 * reach && !pixel.full) light.add(pixel);
  }
  if (light.count == 0 || level.count == 0 || 2 * level.full > level.count) return 0;
  const double own = light.mean_own() - level.mean_own();
  const double excess = light.mean_excess() - level.mean_excess();
  return own >= kLeastLight ? excess / own : 0;
}

}  // namespace

LaserHue hue_from_name(const std::string& name) {
  std::string all;
  for (const auto& [hue, known] : kNames) {
    if (name == known) return hue;
    all += std::string(all.empty() ? "" : ", ") + known;
  }
  fail("expected the hue of a laser (", all, "), got '", name, "'");
}

std::string to_string(LaserHue hue) {
  for (const auto& [known, name] : kNames) {
    if (known == hue) return name;
  }
  return "any";
}

double hue_share(ImageView8 frame, ImageView8 background, const StripePlace& place, LaserHue hue) {
  if (hue == LaserHue::kAny || frame.channels != 3) return 1;
  const ColourRow row(frame, background, place, hue);
  const double width = std::clamp(static_cast<double>(place.width), 1.0, 20.0);
  const auto middle = static_cast<double>(place.position);
  double best = 0;
  for (const double reach : {width, kGlow * width}) {
    for (const int side : {-1, 1}) best = std::max(best, share_beside(row, middle, side, reach));
  }
  return best;
}

}  // namespace facula
