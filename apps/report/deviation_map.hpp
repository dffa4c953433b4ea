// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/apps/report/color_bar.hpp>
#include <facula/apps/report/drawing.hpp>

#include <vector>

namespace facula {

/// Colours for deviations [m]: blue, white, red about 0 where they have a sign, else from dark
/// violet for 0 to yellow. `limit` [m] is the value of the last colour; 0 takes
/// typical_reach().
ColorScale deviation_scale(const std::vector<double>& values, bool has_sign, double limit = 0);

/// The colour of every point; grey where there is no value. The scale's unit is that of its label.
std::vector<Color> deviation_colors(const std::vector<double>& values, const ColorScale& scale);

/// The points in the colours of their deviations from three sides, with colour bar and histogram.
/// Points without a value are left out. Throws Error when there is not one value per point.
Image8 deviation_map(const PointCloud& cloud,
                     const std::vector<double>& values,
                     const ColorScale& scale);

}  // namespace facula
