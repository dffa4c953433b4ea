// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/deviation_histogram.hpp>
#include <facula/apps/report/legend.hpp>
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/plot_axes.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace facula {
namespace {

constexpr Color kBarColor{147, 176, 207};
constexpr Color kCurveColor{150, 20, 40};
constexpr int kBins = 64;
constexpr double kBeyond = 1.25;

struct Histogram {
  double low = 0;   // [m]
  double bin = 0;   // [m]
  double most = 1;  // points in the fullest bin, or of the curve
  std::vector<double> count = std::vector<double>(kBins, 0.0);
  double total = 0;
  double smallest = 0;  // [m]
  double largest = 0;   // [m]
};

double normal_count(const Histogram& histogram, double sigma, double x) {
  const double z = x / sigma;
  return histogram.total * histogram.bin * std::exp(-z * z / 2) /
         (sigma * std::sqrt(2 * std::numbers::pi));
}

Histogram histogram_of(const std::vector<float>& distances,
                       const DeviationHistogramOptions& options) {
  Histogram histogram;
  histogram.low = -kBeyond * options.largest;
  histogram.bin = 2 * kBeyond * options.largest / kBins;
  for (const float distance : distances) {
    if (!std::isfinite(distance)) continue;
    histogram.total += 1;
    histogram.smallest = std::min<double>(histogram.smallest, distance);
    histogram.largest = std::max<double>(histogram.largest, distance);
    const double place = (distance - histogram.low) / histogram.bin;
    if (place >= 0 && place < kBins) histogram.count[static_cast<std::size_t>(place)] += 1;
  }
  histogram.most = std::max(1.0, *std::max_element(histogram.count.begin(), histogram.count.end()));
  return histogram;
}

void draw_bars(Image8& plot, const Histogram& histogram, double top) {
  const PixelBox area = plot_area(plot);
  for (int k = 0; k < kBins; ++k) {
    const double share = histogram.count[static_cast<std::size_t>(k)] / top;
    const int height = static_cast<int>(std::lround(share * area.height));
    const int left = area.x + k * area.width / kBins;
    const int right = area.x + (k + 1) * area.width / kBins;
    fill_box(plot, {left, area.y + area.height - height, right - left - 1, height}, kBarColor);
  }
}

void draw_curve(Image8& plot, const Histogram& histogram, double sigma, double top) {
  const PixelBox area = plot_area(plot);
  const auto at = [&](double px) {
    const double x = histogram.low + px / area.width * kBins * histogram.bin;
    const double share = std::min(1.0, normal_count(histogram, sigma, x) / top);
    return Eigen::Vector2d(area.x + px - 0.5, area.y + area.height - share * area.height);
  };
  for (int px = 0; px < area.width; px += 4) {
    draw_line(plot, at(px), at(px + 4), {kCurveColor, 1.6});
  }
}

Image8 histogram_legend(const Histogram& histogram,
                        const DeviationHistogramOptions& options,
                        int width) {
  std::vector<LegendEntry> entries{
      {kBarColor, format_count(static_cast<std::size_t>(histogram.total)) + " points"}};
  if (options.sigma > 0) {
    entries.push_back({kCurveColor, "normal, sigma = " + format_length(options.sigma)});
  }
  entries.push_back(
      {kInk,
       "from " + format_length(histogram.smallest) + " to " + format_length(histogram.largest),
       false});
  return legend(entries, width);
}

}  // namespace

Image8 deviation_histogram(const std::vector<float>& distances,
                           const DeviationHistogramOptions& options) {
  require(options.largest > 0 && std::isfinite(options.largest),
          "largest must be above 0 m, not ",
          options.largest);
  const Histogram histogram = histogram_of(distances, options);
  const bool curve = options.sigma > 0.1 * histogram.bin;
  double top = histogram.most;
  if (curve) top = std::max(top, normal_count(histogram, options.sigma, 0));
  top *= 1.08;
  Image8 plot = make_plot(options.height, options.width);
  draw_bars(plot, histogram, top);
  if (curve) draw_curve(plot, histogram, options.sigma, top);
  const LengthUnit unit = length_unit_for(options.largest);
  const double end = kBeyond * options.largest * unit.per_metre;
  draw_axes(
      plot, {-end, end, options.label + " [" + unit.name + "]"}, {0, top, "points per bin [1]"});
  return below({plot, histogram_legend(histogram, options, plot.cols)});
}

}  // namespace facula
