// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/report/drawing.hpp>

#include <string>

namespace facula {

/// Values along one side of a plot.
struct PlotAxis {
  double low = 0;     ///< at the left or lower edge
  double high = 1;    ///< at the right or upper edge; may be smaller than low
  std::string label;  ///< quantity and unit, "x [m]"
};

inline constexpr PixelBox kPlotMargin{84, 40, 24, 66};  ///< room left, above, right, below [px]

/// A canvas with room for a plot of this size and its axes; the plot area starts at (kPlotMargin.x,
/// kPlotMargin.y).
Image8 make_plot(int height, int width);

/// Frame, ticks, numbers and labels around the plot area of make_plot().
void draw_axes(Image8& canvas, const PlotAxis& x, const PlotAxis& y);

/// The plot area of a canvas from make_plot().
PixelBox plot_area(const Image8& canvas);

}  // namespace facula
