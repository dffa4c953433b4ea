// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/plot_axes.hpp>
#include <facula/apps/report/text.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr double kTextSize = 18;
constexpr double kTick = 6;  // [px]

/// Closer than the spacing where that would leave fewer than three, which show no scale.
std::vector<double> ticks_of(const PlotAxis& axis, int pixels, int spacing) {
  const int usual = std::max(2, pixels / spacing);
  std::vector<double> ticks;
  for (int count = usual; count <= 2 * usual && ticks.size() < 3; ++count) {
    ticks = round_ticks(std::min(axis.low, axis.high), std::max(axis.low, axis.high), count);
  }
  return ticks;
}

double share_of(const PlotAxis& axis, double value) {
  return (value - axis.low) / (axis.high - axis.low);
}

void draw_x_axis(Image8& canvas, const PixelBox& area, const PlotAxis& axis) {
  const double bottom = area.y + area.height;
  const std::vector<double> ticks = ticks_of(axis, area.width, 110);
  const std::vector<std::string> labels = tick_labels(ticks);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double x = area.x - 0.5 + share_of(axis, ticks[i]) * area.width;
    draw_line(canvas, {x, bottom}, {x, bottom + kTick}, {kFaintInk, 1});
    draw_text(
        canvas, {x, bottom + 19}, labels[i], {.size = kTextSize, .align = TextAlign::kCenter});
  }
  draw_text(canvas,
            {area.x + area.width / 2.0, bottom + 46},
            axis.label,
            {.size = kTextSize, .align = TextAlign::kCenter});
}

void draw_y_axis(Image8& canvas, const PixelBox& area, const PlotAxis& axis) {
  const double left = area.x - 1.0;
  const std::vector<double> ticks = ticks_of(axis, area.height, 70);
  const std::vector<std::string> labels = tick_labels(ticks);
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const double y = area.y + area.height - 0.5 - share_of(axis, ticks[i]) * area.height;
    draw_line(canvas, {left - kTick, y}, {left, y}, {kFaintInk, 1});
    draw_text(
        canvas, {left - kTick - 5, y}, labels[i], {.size = kTextSize, .align = TextAlign::kRight});
  }
  draw_text(canvas, {10.0, area.y - 20.0}, axis.label, {.size = kTextSize});
}

}  // namespace

Image8 make_plot(int height, int width) {
  return make_canvas(height + kPlotMargin.y + kPlotMargin.height,
                     width + kPlotMargin.x + kPlotMargin.width);
}

PixelBox plot_area(const Image8& canvas) {
  return {kPlotMargin.x,
          kPlotMargin.y,
          canvas.cols - kPlotMargin.x - kPlotMargin.width,
          canvas.rows - kPlotMargin.y - kPlotMargin.height};
}

void draw_axes(Image8& canvas, const PlotAxis& x, const PlotAxis& y) {
  const PixelBox area = plot_area(canvas);
  draw_box(canvas, {area.x - 1, area.y - 1, area.width + 2, area.height + 2}, kFaintInk);
  draw_x_axis(canvas, area, x);
  draw_y_axis(canvas, area, y);
}

}  // namespace facula
