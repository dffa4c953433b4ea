// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/design_plot.hpp>
#include <facula/apps/report/drawing.hpp>
#include <facula/apps/report/plot_axes.hpp>

#include <functional>
#include <string>

namespace facula {
namespace {

constexpr Color kCurve{31, 98, 168};
constexpr Color kMark{178, 60, 48};

struct Curve {
  std::string label;
  std::function<double(const RangeDesign&)> value;  ///< [mm]
};

/// A curve over f s, the design marked by a dot and hairlines.
Image8 plot_of(const RangeDesign& design, const Curve& curve) {
  Image8 plot = make_plot(280, 420);
  const double most_fs = 2 * design.fs;
  const double at_design = curve.value(design);
  const double top = 3 * at_design;
  draw_axes(plot, {0, 1e6 * most_fs, "f s [mm^2]"}, {0, top, curve.label});
  const PixelBox area = plot_area(plot);
  const auto at = [&](double fs, double value) {
    return Eigen::Vector2d(area.x + fs / most_fs * area.width,
                           area.y + area.height * (1 - value / top));
  };
  draw_line(plot, at(design.fs, 0), at(design.fs, at_design), {kMark, 1});
  draw_line(plot, at(0, at_design), at(design.fs, at_design), {kMark, 1});
  constexpr int kSteps = 200;
  const auto point = [&](int i) {
    RangeDesign other = design;
    other.fs = most_fs * i / kSteps;
    return std::pair(other.fs, curve.value(other));
  };
  for (int i = 1; i < kSteps; ++i) {
    const auto [x0, y0] = point(i);
    const auto [x1, y1] = point(i + 1);
    if (y0 <= top && y1 <= top) draw_line(plot, at(x0, y0), at(x1, y1), {kCurve, 2});
  }
  draw_disc(plot, at(design.fs, at_design), 4, kMark);
  return plot;
}

}  // namespace

Image8 design_plot(const RangeDesign& design, double distance) {
  const Curve nearest{"nearest distance [mm]",
                      [](const RangeDesign& d) { return 1000 * d.nearest(); }};
  const Curve resolution{
      "resolution at " + std::to_string(static_cast<int>(1000 * distance)) + " mm [mm]",
      [=](const RangeDesign& d) { return 1000 * d.resolution(distance); }};
  return beside({plot_of(design, nearest), plot_of(design, resolution)}, 16);
}

}  // namespace facula
