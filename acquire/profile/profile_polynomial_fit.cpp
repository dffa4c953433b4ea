// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/profile/profile_polynomial_fit.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include <Eigen/QR>

namespace facula {
namespace {

std::size_t check_points(const std::vector<ProfilePoint>& points) {
  std::set<double> positions;
  for (const ProfilePoint& p : points) {
    require(std::isfinite(p.px) && std::isfinite(p.size),
            "expected finite positions and sizes, got ",
            p.px,
            " px and ",
            1000 * p.size,
            " mm");
    positions.insert(p.px);
  }
  require(positions.size() >= 2,
          "expected test pieces at two or more different positions, got ",
          positions.size());
  return positions.size();
}

/// A polynomial of one degree with its residuals.
ProfilePolynomialFit fit_degree(const std::vector<ProfilePoint>& points, int degree) {
  ProfilePolynomialFit fit;
  ProfilePolynomial& p = fit.polynomial;
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(), [](const auto& a, const auto& b) { return a.px < b.px; });
  p.lowest_px = low->px;
  p.highest_px = high->px;
  p.centre = 0.5 * (low->px + high->px);
  p.scale = 0.5 * (high->px - low->px);
  const auto rows = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd design(rows, degree + 1);
  Eigen::VectorXd sizes(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const ProfilePoint& point = points[static_cast<std::size_t>(i)];
    const double t = (point.px - p.centre) / p.scale;
    design(i, 0) = 1;
    for (int k = 1; k <= degree; ++k) design(i, k) = design(i, k - 1) * t;
    sizes[i] = point.size;
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(design);
  const Eigen::VectorXd solution = qr.solve(sizes);
  p.coefficients.assign(solution.data(), solution.data() + solution.size());
  // The error of a point left out is its residual over one minus its leverage.
  const Eigen::MatrixXd basis = qr.householderQ() * Eigen::MatrixXd::Identity(rows, degree + 1);
  const Eigen::VectorXd residual = design * solution - sizes;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double leverage = basis.row(i).squaredNorm();
    fit.residual.push_back(residual[i]);
    fit.held_out.push_back(leverage < 1 - 1e-9 ? residual[i] / (1 - leverage) : std::nan(""));
    fit.held_out_rms += fit.held_out.back() * fit.held_out.back();
  }
  const auto count = static_cast<double>(points.size());
  fit.rms = std::sqrt(residual.squaredNorm() / count);
  fit.held_out_rms = std::sqrt(fit.held_out_rms / count);
  return fit;
}

template <typename... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  (text << ... << parts);
  return text.str();
}

/// A position where the slope changes its sign, within the fitted ones.
std::optional<double> turning_point(const ProfilePolynomial& p) {
  constexpr int kSteps = 400;
  const double step = (p.highest_px - p.lowest_px) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double px = p.lowest_px + i * step;
    if (p.slope(px) * p.slope(px + step) < 0) return px;
  }
  return std::nullopt;
}

std::vector<std::string> warnings_of(const ProfilePolynomialFit& fit) {
  std::vector<std::string> warnings;
  if (const auto px = turning_point(fit.polynomial)) {
    warnings.push_back(sentence("the polynomial turns at ",
                                *px,
                                " px: two positions there give the same size; take a lower degree "
                                "or measure more pieces near it"));
  }
  if (!(fit.held_out_rms <= 3 * fit.rms + 1e-9)) {
    warnings.push_back(sentence("left out, a piece is missed by ",
                                1000 * fit.held_out_rms,
                                " mm where the fit's own residual is ",
                                1000 * fit.rms,
                                " mm: the degree is too high for so few pieces"));
  }
  warnings.push_back(sentence("sizes outside ",
                              fit.polynomial.lowest_px,
                              " to ",
                              fit.polynomial.highest_px,
                              " px are extrapolated and not to be trusted"));
  return warnings;
}

/// Mean of the squared errors of the points left out, and how well so few of them know it.
struct HeldOut {
  double mean = 0;
  double standard_error = 0;
};

HeldOut held_out_of(const ProfilePolynomialFit& fit) {
  HeldOut h;
  const auto count = static_cast<double>(fit.held_out.size());
  for (const double e : fit.held_out) h.mean += e * e / count;
  double variance = 0;
  for (const double e : fit.held_out) variance += std::pow(e * e - h.mean, 2) / (count - 1);
  h.standard_error = std::sqrt(variance / count);
  return h;
}

/// The lowest degree that is not worse than the best by more than the best's standard error
/// (Breiman, Friedman, Olshen, Stone 1984, 3.4.3): an error from few points is itself noisy.
std::size_t chosen(const std::vector<ProfilePolynomialFit>& fits) {
  HeldOut best = held_out_of(fits.front());
  for (const ProfilePolynomialFit& fit : fits) {
    const HeldOut h = held_out_of(fit);
    if (h.mean < best.mean) best = h;
  }
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (held_out_of(fits[i]).mean <= best.mean + best.standard_error + 1e-20) return i;
  }
  return 0;
}

}  // namespace

void ProfilePolynomialOptions::check() const {
  require(!degree || (*degree >= 1 && *degree <= 12),
          "expected a degree of 1 to 12, got ",
          degree.value_or(0));
  require(max_degree >= 1 && max_degree <= 12,
          "expected a highest degree of 1 to 12, got ",
          max_degree);
}

ProfilePolynomialFit fit_profile_polynomial(const std::vector<ProfilePoint>& points,
                                            const ProfilePolynomialOptions& options) {
  options.check();
  const std::size_t positions = check_points(points);
  const int highest = static_cast<int>(std::min<std::size_t>(positions, 14)) - 2;
  const int least = options.degree.value_or(1);
  require(least <= highest,
          "a polynomial of degree ",
          least,
          " needs ",
          least + 2,
          " different positions (one to check by), got ",
          positions,
          "; lower the degree or measure more pieces");
  std::vector<ProfilePolynomialFit> fits;
  std::vector<PolynomialTrial> trials;
  for (int degree = 1; degree <= std::min(highest, std::max(options.max_degree, least)); ++degree) {
    fits.push_back(fit_degree(points, degree));
    trials.push_back({degree, fits.back().rms, fits.back().held_out_rms});
  }
  ProfilePolynomialFit best = std::move(
      fits[options.degree ? static_cast<std::size_t>(*options.degree - 1) : chosen(fits)]);
  best.trials = std::move(trials);
  best.warnings = warnings_of(best);
  return best;
}

}  // namespace facula
