// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/range_fit.hpp>
#include <facula/acquire/two_line/two_line_fit.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace facula {
namespace {

/// Least squares of separation = spacing / distance.
double parallel_spacing(const std::vector<TwoLinePoint>& points, std::size_t without) {
  double above = 0;
  double below = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == without) continue;
    above += points[i].separation / points[i].distance;
    below += 1 / (points[i].distance * points[i].distance);
  }
  return above / below;
}

void check_points(const std::vector<TwoLinePoint>& points) {
  require(points.size() >= 2, "expected separations at two or more distances, got ", points.size());
  require(std::any_of(points.begin(),
                      points.end(),
                      [&](const TwoLinePoint& p) { return p.distance != points[0].distance; }),
          "all ",
          points.size(),
          " distances are equal (",
          1000 * points[0].distance,
          " mm): nothing checks the spacing they give; measure near and far ones");
  for (const TwoLinePoint& p : points) {
    require(std::isfinite(p.separation) && std::isfinite(p.distance) && p.distance > 0,
            "expected finite separations and distances above 0, got ",
            p.separation,
            " at ",
            1000 * p.distance,
            " mm");
    require(p.separation > 0,
            "expected separations above 0, got ",
            p.separation,
            " at ",
            1000 * p.distance,
            " mm; the separation is that of the lower from the upper line");
  }
}

/// Lines that part, or stay as they are, while the surface goes away are not those of such a head.
void check_trend(const std::vector<TwoLinePoint>& points) {
  const auto count = static_cast<double>(points.size());
  double near = 0;
  double separation = 0;
  for (const TwoLinePoint& p : points) {
    near += 1 / (p.distance * count);
    separation += p.separation / count;
  }
  double spread = 0;
  double together = 0;
  for (const TwoLinePoint& p : points) {
    const double off = 1 / p.distance - near;
    spread += off * off;
    together += off * (p.separation - separation);
  }
  if (!(spread > 1e-12 * count * near * near)) return;  // one distance has no trend
  require(together > 1e-9 * separation * std::sqrt(spread),
          "the separations grow with the distance or stay the same: expected the lower line minus "
          "the upper one, smaller the farther away; check that separations and distances belong "
          "together");
}

TwoLineFit fit_parallel(const std::vector<TwoLinePoint>& points) {
  TwoLineFit fit;
  fit.head.spacing = parallel_spacing(points, points.size());
  double squares = 0;
  double held_out = 0;
  double weights = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const TwoLinePoint& p = points[i];
    fit.residual.push_back(fit.head.spacing / p.separation - p.distance);
    squares += std::pow(p.separation - fit.head.spacing / p.distance, 2);
    held_out += std::pow(parallel_spacing(points, i) / p.separation - p.distance, 2);
    weights += 1 / (p.distance * p.distance);
  }
  const auto count = static_cast<double>(points.size());
  fit.rms_separation = std::sqrt(squares / count);
  fit.spacing_sigma = std::sqrt(squares / (count - 1) / weights);
  fit.held_out_rms = std::sqrt(held_out / count);
  return fit;
}

/// Sheets that drift apart are the range hyperbola with the separation as its position:
/// distance = -spacing / (divergence - separation). None where the points cannot tell the drift,
/// as with two distances only.
std::optional<TwoLineFit> fit_drifting(const std::vector<TwoLinePoint>& points) {
  std::vector<RangePoint> range_points;
  range_points.reserve(points.size());
  for (const TwoLinePoint& p : points) range_points.push_back({p.separation, p.distance});
  RangeFit range;
  try {
    range = fit_range(range_points, {.centre = 0});
  } catch (const Error&) {
    return std::nullopt;
  }
  if (!(range.model.slope < 0)) return std::nullopt;
  TwoLineFit fit;
  fit.head.spacing = -range.model.slope;
  fit.head.divergence = range.model.vanishing;
  fit.spacing_sigma = range.sigma[0];
  fit.divergence_sigma = range.sigma[1];
  fit.residual = range.residual;
  fit.rms_separation = range.rms_px;
  fit.held_out_rms = range.held_out_rms;
  return fit;
}

}  // namespace

TwoLineFit fit_two_line(const std::vector<TwoLinePoint>& points, const TwoLineFitOptions& options) {
  check_points(points);
  check_trend(points);
  TwoLineFit fit = fit_parallel(points);
  const double parallel = fit.held_out_rms;
  if (options.divergence && points.size() >= 3) {
    const std::optional<TwoLineFit> drifting = fit_drifting(points);
    if (drifting && drifting->held_out_rms < parallel) fit = *drifting;
  }
  fit.parallel_held_out_rms = parallel;
  fit.head.medium_index = options.medium_index;
  fit.head.check();
  double squares = 0;
  for (const double r : fit.residual) squares += r * r;
  fit.rms = std::sqrt(squares / static_cast<double>(points.size()));
  if (points.size() < 4) {
    fit.warnings.emplace_back(
        "few distances: measure four or more, near and far, so that sheets that are not parallel "
        "show themselves");
  }
  if (std::abs(fit.head.divergence) > 2 * fit.divergence_sigma && fit.head.divergence != 0) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "the sheets are not parallel: they drift " << 1000 * fit.head.divergence
         << " mm per metre; taken as parallel, as the source does, the error would be "
         << 1000 * parallel << " mm";
    fit.warnings.push_back(text.str());
  }
  return fit;
}

}  // namespace facula
