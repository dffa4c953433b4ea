// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/range_fit.hpp>
#include <facula/acquire/range/range_warnings.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <Eigen/Cholesky>
#include <Eigen/QR>

namespace facula {
namespace {

double cubed(double x) {
  return x * x * x;
}

/// slope, vanishing, and bend or origin.
using Parameters = Eigen::VectorXd;

RangeModel model_of(const Parameters& p, const RangeFitOptions& options) {
  RangeModel model{.slope = p[0], .vanishing = p[1], .centre = options.centre};
  if (options.terms == RangeTerms::kBend) model.bend = p[2];
  return model;
}

double origin_of(const Parameters& p, const RangeFitOptions& options) {
  return options.terms == RangeTerms::kOrigin ? p[2] : 0;
}

/// Modelled - measured distance [m]; NaN beyond the vanishing position.
double distance_residual(const RangePoint& point, const Parameters& p, const RangeFitOptions& o) {
  const auto depth = model_of(p, o).depth(point.px);
  return depth ? *depth + origin_of(p, o) - point.distance : std::nan("");
}

/// Measured - modelled position [px].
double pixel_residual(const RangePoint& point, const Parameters& p, const RangeFitOptions& o) {
  const RangeModel model = model_of(p, o);
  return point.px - model.position(point.distance - origin_of(p, o));
}

struct Equations {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
};

/// One row of the least squares problem and its derivative.
void write_row(const RangePoint& point,
               const Parameters& p,
               const RangeFitOptions& o,
               Eigen::Ref<Eigen::RowVectorXd> derivative,
               double& residual) {
  const double bend = o.terms == RangeTerms::kBend ? p[2] : 0;
  const double off = cubed(point.px - o.centre);
  if (o.minimise == RangeResidual::kDistances) {
    const double below = p[1] - point.px - bend * off;
    residual = p[0] / below + origin_of(p, o) - point.distance;
    const double square = p[0] / (below * below);
    derivative.head<2>() << 1 / below, -square;
    if (o.terms == RangeTerms::kBend) derivative[2] = square * off;
    if (o.terms == RangeTerms::kOrigin) derivative[2] = 1;
    return;
  }
  const double depth = point.distance - origin_of(p, o);
  residual = point.px + bend * off - p[1] + p[0] / depth;
  derivative.head<2>() << 1 / depth, -1;
  if (o.terms == RangeTerms::kBend) derivative[2] = off;
  if (o.terms == RangeTerms::kOrigin) derivative[2] = p[0] / (depth * depth);
}

Equations equations(const std::vector<RangePoint>& points,
                    const Parameters& p,
                    const RangeFitOptions& options) {
  const auto rows = static_cast<Eigen::Index>(points.size());
  Equations e{Eigen::MatrixXd(rows, p.size()), Eigen::VectorXd(rows)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    Eigen::RowVectorXd derivative(p.size());
    write_row(points[static_cast<std::size_t>(i)], p, options, derivative, e.residual[i]);
    e.jacobian.row(i) = derivative;
  }
  return e;
}

/// The plain hyperbola over the pixels is linear: px = x0 - A / d.
Parameters start_of(const std::vector<RangePoint>& points, const RangeFitOptions& options) {
  RangeFitOptions linear = options;
  linear.terms = RangeTerms::kPlain;
  linear.minimise = RangeResidual::kPixels;
  const Equations e = equations(points, Parameters::Zero(2), linear);
  Parameters p = Parameters::Zero(options.terms == RangeTerms::kPlain ? 2 : 3);
  p.head<2>() = e.jacobian.colPivHouseholderQr().solve(-e.residual);
  return p;
}

/// Whether every point lies on the near side of the vanishing position and beyond the origin.
bool possible(const std::vector<RangePoint>& points,
              const Parameters& p,
              const RangeFitOptions& options) {
  return p.allFinite() && std::all_of(points.begin(), points.end(), [&](const RangePoint& point) {
           return std::isfinite(distance_residual(point, p, options)) &&
                  point.distance > origin_of(p, options);
         });
}

/// Levenberg and Marquardt's damped least squares; a handful of unknowns.
Parameters refine(const std::vector<RangePoint>& points,
                  Parameters p,
                  const RangeFitOptions& options) {
  double damping = 1e-6;
  Equations e = equations(points, p, options);
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd scale = e.jacobian.colwise().norm().transpose().cwiseMax(1e-300);
    const Eigen::MatrixXd scaled = e.jacobian * scale.cwiseInverse().asDiagonal();
    Eigen::MatrixXd normal = scaled.transpose() * scaled;
    normal.diagonal().array() *= 1 + damping;
    const Eigen::VectorXd step =
        normal.ldlt().solve(-(scaled.transpose() * e.residual)).cwiseQuotient(scale);
    const Parameters next = p + step;
    const bool allowed = possible(points, next, options);
    Equations there = allowed ? equations(points, next, options) : e;
    if (!allowed || there.residual.squaredNorm() > e.residual.squaredNorm()) {
      damping *= 10;
      if (damping > 1e12) break;
      continue;
    }
    const bool settled = (step.cwiseProduct(scale)).norm() < 1e-11 * (1e-6 + e.residual.norm());
    p = next;
    e = std::move(there);
    damping = std::max(1e-12, damping / 10);
    if (settled) break;
  }
  return p;
}

std::optional<Parameters> solve(const std::vector<RangePoint>& points,
                                const RangeFitOptions& options) {
  const Parameters start = start_of(points, options);
  if (!possible(points, start, options)) return std::nullopt;
  const Parameters p = refine(points, start, options);
  if (!possible(points, p, options)) return std::nullopt;
  return p;
}

/// Two points or more must differ in both what was seen and what was measured.
void check_spread(const std::vector<RangePoint>& points, std::size_t different_distances) {
  const auto [least, most] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.px < b.px; });
  require(least->px < most->px,
          "all ",
          points.size(),
          " positions are equal (",
          points.front().px,
          " px): a line that does not move with the distance measures none; check that the "
          "positions are those of the laser line");
  require(different_distances > 1,
          "all ",
          points.size(),
          " distances are equal (",
          1000 * points.front().distance,
          " mm): one distance cannot give slope and vanishing position; measure near and far ones");
}

void check_points(const std::vector<RangePoint>& points, const RangeFitOptions& options) {
  const std::size_t parameters = options.terms == RangeTerms::kPlain ? 2 : 3;
  std::set<double> distances;
  for (const RangePoint& point : points) {
    require(std::isfinite(point.px) && std::isfinite(point.distance),
            "expected finite positions and distances, got ",
            point.px,
            " px at ",
            1000 * point.distance,
            " mm");
    require(point.distance > 0, "expected distances above 0, got ", 1000 * point.distance, " mm");
    distances.insert(point.distance);
  }
  if (points.size() > 1) check_spread(points, distances.size());
  require(distances.size() > parameters,
          "expected at least ",
          parameters + 1,
          " different distances for the ",
          to_string(options.terms),
          " range model, got ",
          distances.size(),
          ": with no more distances than unknowns every fit is perfect and none can be checked; "
          "measure more of them");
}

void fail_without_hyperbola(const std::vector<RangePoint>& points, const RangeFitOptions& options) {
  const Parameters p = start_of(points, options);
  for (const RangePoint& point : points) {
    if (RangeModel{.slope = p[0], .vanishing = p[1]}.depth(point.px)) continue;
    fail("the stripe at ",
         point.px,
         " px (",
         1000 * point.distance,
         " mm) lies beyond ",
         p[1],
         " px, where the other points put infinity; check that point, or measure more near ones");
  }
  fail(
      "the points do not follow d = A / (x0 - px); check that positions and distances belong "
      "together");
}

/// What the fit leaves, and what each point's absence would have left.
void judge(const std::vector<RangePoint>& points,
           const Parameters& p,
           const RangeFitOptions& options,
           RangeFit& fit) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    fit.residual_px.push_back(pixel_residual(points[i], p, options));
    fit.residual.push_back(distance_residual(points[i], p, options));
    std::vector<RangePoint> others = points;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto without = solve(others, options);
    fit.held_out_px.push_back(without ? pixel_residual(points[i], *without, options)
                                      : std::nan(""));
    fit.held_out.push_back(without ? distance_residual(points[i], *without, options)
                                   : std::nan(""));
  }
}

double rms_of(const std::vector<double>& values) {
  const auto count = static_cast<Eigen::Index>(values.size());
  return std::sqrt(Eigen::Map<const Eigen::VectorXd>(values.data(), count).squaredNorm() /
                   static_cast<double>(count));
}

Eigen::MatrixXd covariance_of(const std::vector<RangePoint>& points,
                              const Parameters& p,
                              const RangeFitOptions& options) {
  const Equations e = equations(points, p, options);
  const Eigen::VectorXd scale = e.jacobian.colwise().norm().transpose();
  const Eigen::MatrixXd scaled = e.jacobian * scale.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd inverse =
      (scaled.transpose() * scaled).ldlt().solve(Eigen::MatrixXd::Identity(p.size(), p.size()));
  const double variance =
      e.residual.squaredNorm() / static_cast<double>(e.residual.size() - p.size());
  return variance *
         (scale.cwiseInverse().asDiagonal() * inverse * scale.cwiseInverse().asDiagonal());
}

}  // namespace

void RangeFitOptions::check() const {
  require(std::isfinite(centre), "expected a finite centre of the picture, got ", centre, " px");
}

RangeFit fit_range(const std::vector<RangePoint>& points, const RangeFitOptions& options) {
  options.check();
  check_points(points, options);
  const auto p = solve(points, options);
  if (!p) fail_without_hyperbola(points, options);
  RangeFit fit;
  fit.terms = options.terms;
  fit.minimised = options.minimise;
  fit.model = model_of(*p, options);
  fit.origin = origin_of(*p, options);
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.px < b.px; });
  fit.model.lowest_px = low->px;
  fit.model.highest_px = high->px;
  fit.model.check();
  const Eigen::MatrixXd covariance = covariance_of(points, *p, options);
  const Eigen::Index in_model = options.terms == RangeTerms::kBend ? 3 : 2;
  fit.model.covariance.topLeftCorner(in_model, in_model) =
      covariance.topLeftCorner(in_model, in_model);
  fit.sigma = covariance.diagonal().cwiseSqrt();
  judge(points, *p, options, fit);
  fit.rms_px = rms_of(fit.residual_px);
  fit.rms = rms_of(fit.residual);
  fit.held_out_rms_px = rms_of(fit.held_out_px);
  fit.held_out_rms = rms_of(fit.held_out);
  fit.warnings = range_warnings(points, fit);
  return fit;
}

std::vector<RangeFit> compare_range_models(const std::vector<RangePoint>& points,
                                           const RangeFitOptions& options) {
  RangeFitOptions trial = options;
  trial.terms = RangeTerms::kPlain;
  std::vector<RangeFit> fits = {fit_range(points, trial)};
  for (const RangeTerms terms : {RangeTerms::kBend, RangeTerms::kOrigin}) {
    trial.terms = terms;
    try {
      fits.push_back(fit_range(points, trial));
    } catch (const Error&) {
      continue;  // These points do not allow it; the plain one stands.
    }
  }
  const auto error = [&](const RangeFit& fit) {
    const double rms =
        options.minimise == RangeResidual::kPixels ? fit.held_out_rms_px : fit.held_out_rms;
    return std::isfinite(rms) ? rms : HUGE_VAL;
  };
  std::stable_sort(fits.begin(), fits.end(), [&](const RangeFit& a, const RangeFit& b) {
    return error(a) < error(b);
  });
  return fits;
}

std::string to_string(RangeTerms terms) {
  if (terms == RangeTerms::kBend) return "bend";
  return terms == RangeTerms::kOrigin ? "origin" : "plain";
}

}  // namespace facula
