// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/color_bar.hpp>
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/text.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr int kTop = 52;     // room for the label [px]
constexpr int kBottom = 14;  // [px]
constexpr int kBarWidth = 22;
constexpr int kTextSize = 18;

double place_of(const ColorScale& scale, const PixelBox& bar, double value) {
  const double share = (value - scale.low) / (scale.high - scale.low);
  return bar.y + bar.height - 0.5 - share * bar.height;
}

void fill_bar(Image8& canvas, const ColorScale& scale, const PixelBox& bar) {
  for (int y = 0; y < bar.height; ++y) {
    const double t = 1.0 - (y + 0.5) / bar.height;
    fill_box(canvas, {bar.x, bar.y + y, bar.width, 1}, color_at(scale.map, t));
  }
  draw_box(canvas, bar, kFaintInk);
}

}  // namespace

Image8 color_bar(const ColorScale& scale, int height) {
  const int rows = std::max(height, 60 + kTop + kBottom);
  const PixelBox bar{12, kTop, kBarWidth, rows - kTop - kBottom};
  const std::vector<double> ticks = round_ticks(scale.low, scale.high, std::max(3, rows / 70));
  const std::vector<std::string> labels = tick_labels(ticks);
  double widest = text_width(scale.label, kTextSize);
  for (const std::string& text : labels) {
    widest = std::max(widest, kBarWidth + 14 + text_width(text, kTextSize));
  }
  Image8 canvas = make_canvas(rows, bar.x + static_cast<int>(std::ceil(widest)) + 14);
  draw_text(canvas, {static_cast<double>(bar.x), 22}, scale.label, {.size = kTextSize});
  fill_bar(canvas, scale, bar);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double y = place_of(scale, bar, ticks[i]);
    const int right = bar.x + bar.width;
    fill_box(canvas, {right, static_cast<int>(std::lround(y)), 6, 1}, kInk);
    draw_text(canvas, {right + 12.0, y}, labels[i], {.size = kTextSize});
  }
  return canvas;
}

ValueRange robust_range(std::vector<float> values, double share) {
  std::erase_if(values, [](float value) { return !std::isfinite(value); });
  if (values.empty()) return {};
  const auto skip = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + skip, values.end());
  const double low = values[static_cast<std::size_t>(skip)];
  std::nth_element(values.begin(), values.end() - 1 - skip, values.end());
  const double high = *(values.end() - 1 - skip);
  const double least = std::max(1e-6, 1e-5 * std::abs(high));
  if (high - low >= least) return {low, high};
  return {low - least / 2, high + least / 2};
}

}  // namespace facula
