// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/deviation_histogram.hpp>
#include <facula/apps/report/deviation_map.hpp>
#include <facula/apps/report/legend.hpp>
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/scan_picture.hpp>
#include <facula/reconstruct/measure/deviation.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace facula {
namespace {

constexpr Color kNoValue{150, 152, 156};

/// The scale's label ends in its unit, "deviation [mm]".
double per_metre_of(const ColorScale& scale) {
  if (scale.label.ends_with("[m]")) return 1;
  return scale.label.ends_with("[mm]") ? 1e3 : 1e6;
}

}  // namespace

ColorScale deviation_scale(const std::vector<double>& values, bool has_sign, double limit) {
  if (!(limit > 0)) limit = std::max(typical_reach(values), 1e-7);
  const LengthUnit unit = length_unit_for(limit);
  const double end = limit * unit.per_metre;
  const std::string in_unit = std::string(" [") + unit.name + "]";
  if (!has_sign) return {ColorMap::kViridis, 0, end, "distance" + in_unit};
  return {ColorMap::kDiverging, -end, end, "deviation" + in_unit};
}

std::vector<Color> deviation_colors(const std::vector<double>& values, const ColorScale& scale) {
  const double per_metre = per_metre_of(scale);
  std::vector<Color> colors;
  colors.reserve(values.size());
  for (const double value : values) {
    colors.push_back(std::isfinite(value) ? scale.at(value * per_metre) : kNoValue);
  }
  return colors;
}

Image8 deviation_map(const PointCloud& cloud,
                     const std::vector<double>& values,
                     const ColorScale& scale) {
  require(values.size() == cloud.size(),
          "expected a deviation for each of ",
          cloud.size(),
          " points, got ",
          values.size());
  std::vector<std::size_t> kept;
  std::vector<double> numbers;
  std::vector<float> short_numbers;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    kept.push_back(i);
    numbers.push_back(values[i]);
    short_numbers.push_back(static_cast<float>(values[i]));
  }
  if (kept.empty()) return empty_picture("No point has a counterpart to deviate from.");
  PointCloud shown;
  for (const std::size_t i : kept) shown.points.push_back(cloud.points[i]);
  shown.colors = deviation_colors(numbers, scale);
  const Image8 views = scan_picture(shown);
  const Image8 map = beside({views, color_bar(scale, std::max(60, views.rows - 40))});
  const Image8 histogram =
      deviation_histogram(short_numbers,
                          {.largest = scale.high / per_metre_of(scale),
                           .width = std::clamp(map.cols - 300, 480, 900),
                           .label = scale.label.substr(0, scale.label.find(" ["))});
  return below({map, histogram}, 12);
}

}  // namespace facula
