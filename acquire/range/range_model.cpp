// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/range_model.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

double cubed(double x) {
  return x * x * x;
}

/// What stands below the fraction line [px].
double from_vanishing(const RangeModel& m, double px) {
  return m.vanishing - px - m.bend * cubed(px - m.centre);
}

/// -d from_vanishing / d px.
double steepness(const RangeModel& m, double px) {
  return 1 + 3 * m.bend * (px - m.centre) * (px - m.centre);
}

}  // namespace

std::optional<double> RangeModel::depth(double px) const {
  const double depth = slope / from_vanishing(*this, px);
  if (!(depth > 0) || !std::isfinite(depth)) return std::nullopt;
  return depth;
}

double RangeModel::position(double depth) const {
  // Newton's method on the bend, which is small against the way the stripe travels.
  double px = vanishing - slope / depth;
  if (bend == 0) return px;
  const double target = slope / depth;
  for (int i = 0; i < 20; ++i) {
    const double step = (from_vanishing(*this, px) - target) / steepness(*this, px);
    px += step;
    if (std::abs(step) < 1e-12 * std::max(1.0, std::abs(px))) break;
  }
  return px;
}

double RangeModel::depth_per_px(double px) const {
  const double below = from_vanishing(*this, px);
  return slope / (below * below) * steepness(*this, px);
}

double RangeModel::calibration_sigma(double px) const {
  const double below = from_vanishing(*this, px);
  const double square = slope / (below * below);
  const Eigen::Vector3d gradient(1 / below, -square, square * cubed(px - centre));
  return std::sqrt(std::max(0.0, gradient.dot(covariance * gradient)));
}

void RangeModel::check() const {
  for (const double value : {slope, vanishing, bend, centre, lowest_px, highest_px}) {
    require(std::isfinite(value), "expected finite numbers in the range model, got ", value);
  }
  require(covariance.allFinite(), "expected a finite covariance of the range model");
  require(slope != 0, "expected a slope of the range model other than 0 px mm");
  require(lowest_px <= highest_px,
          "expected the range model's lowest fitted position below its highest, got ",
          lowest_px,
          " and ",
          highest_px,
          " px");
  require(steepness(*this, lowest_px) > 0 && steepness(*this, highest_px) > 0,
          "the range model's bend of ",
          bend,
          " /px^2 is so strong that the stripe turns back within the fitted positions; fit it "
          "without the bend");
}

}  // namespace facula
