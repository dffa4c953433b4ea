// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/fir_clipped.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace facula {
namespace {

constexpr double kPi = std::numbers::pi;
// What cos(4 pi h) keeps for h to 0.05 px: exp(-2 (2 pi 0.05)^2).
constexpr double kKnownHalf = 0.82;

/// The clip's edge on one side of the line's middle, and the slope there.
struct Edge {
  double half = 0;   ///< [px]
  double slope = 0;  ///< [DN/px]
};

/// From the first two pixels beside the clipped ones, on the side of `step`.
Edge edge_of(const SignalRow& row, int c, int step, double sigma, const StripeCandidate& found) {
  while (row.holds(c + step) && row.is_clipped(c + step)) c += step;
  const double background = static_cast<double>(found.background);
  const double clip = row.at(c) - background;
  const double x0 = std::abs(c + step - static_cast<double>(found.position));
  const double x1 = x0 + 1;
  const double v0 = row.at(c + step) - background;
  const double v1 = row.at(c + 2 * step) - background;
  double w2 = sigma * sigma;
  if (v0 > v1 && v1 > 0) w2 = (x1 * x1 - x0 * x0) / (2 * std::log(v0 / v1));
  const double h2 = v0 > 0 && clip > v0 ? x0 * x0 - 2 * w2 * std::log(clip / v0) : 0;
  const double half = std::sqrt(std::max(h2, (x0 - 1) * (x0 - 1)));
  return {half, std::max(0.0, clip) * half / w2};
}

/// Share of the noise of a Gaussian derivative that lies farther out than z of its widths.
double noise_beyond(double z) {
  return std::erfc(z) + 2 * z * std::exp(-z * z) / std::sqrt(kPi);
}

}  // namespace

void judge_clipped(const SignalRow& row, float sigma, float bend, StripeCandidate& found) {
  const int c = static_cast<int>(std::lround(found.position));
  if (!row.holds(c) || !row.is_clipped(c) || !(bend > 0)) return;
  const auto s = static_cast<double>(sigma);
  const Edge left = edge_of(row, c, -1, s, found);
  const Edge right = edge_of(row, c, 1, s, found);
  // One side at a time: beside a clipped surface the other edge may lie far away.
  const double share = 0.5 * (noise_beyond(left.half / s) + noise_beyond(right.half / s));
  found.sigma_per_noise *= static_cast<float>(std::sqrt(share));

  const double half = 0.5 * (left.half + right.half);
  const double z = half / s;
  const double kernel = half / (s * s) * std::exp(-0.5 * z * z) / (s * std::sqrt(2 * kPi));
  const double kink = 0.5 * (left.slope + right.slope);
  const double most = kink * kernel / (kPi * kPi * static_cast<double>(bend));
  const double turned = 0.5 * (1 - kKnownHalf * std::cos(4 * kPi * half));  // sin^2(2 pi h)
  const auto step = static_cast<float>(most * std::sqrt(0.5 * turned));
  found.sigma_step = std::hypot(found.sigma_step, step);
}

}  // namespace facula
