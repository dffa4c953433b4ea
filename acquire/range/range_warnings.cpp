// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/range/range_warnings.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace facula {
namespace {

template <typename... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  (text << ... << parts);
  return text.str();
}

void warn_of_third(const RangeFit& fit, std::vector<std::string>& warnings) {
  if (fit.sigma.size() < 3) return;
  const bool bend = fit.terms == RangeTerms::kBend;
  const double value = bend ? fit.model.bend : 1000 * fit.origin;
  const double sigma = bend ? fit.sigma[2] : 1000 * fit.sigma[2];
  if (std::abs(value) > 2 * sigma) return;
  warnings.push_back(sentence("these distances cannot tell the ",
                              to_string(fit.terms),
                              " from 0: ",
                              value,
                              " +- ",
                              sigma,
                              bend ? " /px^2" : " mm",
                              "; use the plain model or measure more distances, the nearest above "
                              "all"));
}

void warn_of_span(const std::vector<RangePoint>& points, std::vector<std::string>& warnings) {
  const auto [near, far] = std::minmax_element(
      points.begin(), points.end(), [](const RangePoint& a, const RangePoint& b) {
        return a.distance < b.distance;
      });
  if (far->distance > 2 * near->distance) return;
  warnings.push_back(sentence("the distances lie close together (",
                              1000 * near->distance,
                              " to ",
                              1000 * far->distance,
                              " mm): slope and vanishing position trade for each other; add one "
                              "at less than half and one at twice the distance"));
}

void warn_of_slope(const RangeFit& fit, std::vector<std::string>& warnings) {
  const double share = fit.sigma[0] / std::abs(fit.model.slope);
  if (share < 0.01) return;
  warnings.push_back(sentence("the slope is known to ",
                              100 * share,
                              " % only, and every distance with it; measure nearer distances"));
}

void warn_of_points(const std::vector<RangePoint>& points,
                    const RangeFit& fit,
                    std::vector<std::string>& warnings) {
  const bool in_pixels = fit.minimised == RangeResidual::kPixels;
  const std::vector<double>& held_out = in_pixels ? fit.held_out_px : fit.held_out;
  const double unit = in_pixels ? 1 : 1000;
  const char* unit_name = in_pixels ? " px" : " mm";
  std::vector<double> sizes;
  for (const double r : held_out) {
    if (std::isfinite(r)) sizes.push_back(std::abs(r));
  }
  const double usual = median(sizes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double left_out = held_out[i];
    if (!std::isfinite(left_out)) {
      warnings.push_back(
          sentence("without the point at ",
                   1000 * points[i].distance,
                   " mm nothing could be fitted: the calibration hangs on it alone"));
    } else if (std::abs(left_out) > 5 * usual && std::abs(left_out) * unit > 1e-6) {
      warnings.push_back(sentence("the point at ",
                                  1000 * points[i].distance,
                                  " mm lies ",
                                  unit * left_out,
                                  unit_name,
                                  " from where the others put it (typical ",
                                  unit * usual,
                                  unit_name,
                                  "): measure it again, or add distances near it"));
    }
  }
}

}  // namespace

std::vector<std::string> range_warnings(const std::vector<RangePoint>& points,
                                        const RangeFit& fit) {
  std::vector<std::string> warnings;
  warn_of_third(fit, warnings);
  warn_of_span(points, warnings);
  warn_of_slope(fit, warnings);
  warn_of_points(points, fit, warnings);
  return warnings;
}

}  // namespace facula
