// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/peak_shape.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace facula {
namespace {

constexpr double kFwhm = 2.354820045;  // full width at half height of a Gaussian over its sigma

void find_top(const SignalRow& row, int peak, double sigma, PeakShape& shape) {
  const int reach = std::max(2, static_cast<int>(std::lround(1.5 * sigma)));
  shape.top = std::numeric_limits<int>::min();
  const int end = std::min(row.end, peak + reach + 1);
  for (int c = std::max(row.begin, peak - reach); c < end; ++c) {
    if (row.at(c) > shape.top) {
      shape.top = row.at(c);
      shape.first = c;
    }
    if (row.at(c) == shape.top) shape.last = c;
  }
  while (row.holds(shape.first - 1) && row.at(shape.first - 1) == shape.top) --shape.first;
  while (row.holds(shape.last + 1) && row.at(shape.last + 1) == shape.top) ++shape.last;
}

void measure_surroundings(const SignalRow& row, double sigma, PeakShape& shape) {
  const int near = static_cast<int>(std::ceil(4 * sigma));
  const int far = static_cast<int>(std::ceil(6 * sigma));
  double sum = 0;
  for (int d = near; d <= far; ++d) {
    for (const int c : {shape.first - d, shape.last + d}) {
      if (!row.holds(c)) continue;
      sum += row.at(c);
      ++shape.background_count;
    }
  }
  shape.background = shape.background_count > 0 ? sum / shape.background_count : 0;
}

/// Steps from `c` by `step` to the first pixel below `level`; none at the row's end.
std::optional<int> first_below(const SignalRow& row, int c, int step, double level) {
  while (row.holds(c)) {
    if (row.at(c) < level) return c;
    c += step;
  }
  return std::nullopt;
}

}  // namespace

std::optional<PeakShape> peak_shape(const SignalRow& row, int peak, double sigma) {
  if (row.empty()) return std::nullopt;
  PeakShape shape;
  find_top(row, std::clamp(peak, row.begin, row.end - 1), sigma, shape);
  measure_surroundings(row, sigma, shape);
  if (!(shape.height() > 0)) return std::nullopt;
  return shape;
}

std::optional<Crossings> crossings(const SignalRow& row, const PeakShape& shape, double share) {
  const double level = shape.background + share * shape.height();
  const auto left = first_below(row, shape.first, -1, level);
  const auto right = first_below(row, shape.last, 1, level);
  if (!left || !right) return std::nullopt;
  Crossings found;
  found.left_slope = row.at(*left + 1) - row.at(*left);
  found.right_slope = row.at(*right - 1) - row.at(*right);
  found.left = *left + (level - row.at(*left)) / found.left_slope;
  found.right = *right - (level - row.at(*right)) / found.right_slope;
  return found;
}

std::optional<StripeCandidate> describe_peak(const SignalRow& row, const PeakShape& shape) {
  const auto half = crossings(row, shape, 0.5);
  if (!half) return std::nullopt;
  StripeCandidate found;
  found.width = static_cast<float>((half->right - half->left) / kFwhm);
  found.amplitude = static_cast<float>(shape.height());
  found.background = static_cast<float>(shape.background);
  found.saturated = row.is_clipped(shape.middle());
  // The top against the mean of its surroundings.
  found.snr_per_noise = static_cast<float>(
      shape.height() / std::sqrt(1.0 + 1.0 / std::max(1, shape.background_count)));
  found.position = static_cast<float>(0.5 * (half->left + half->right));
  measure_misfit(row, found);
  found.position = static_cast<float>(shape.middle());
  return found;
}

void measure_misfit(const SignalRow& row, StripeCandidate& found, double most_reach) {
  const double width = std::clamp(static_cast<double>(found.width), 0.5, 1.0 * row.end);
  const double position = static_cast<double>(found.position);
  const double reach = std::min(3 * width, most_reach);
  const int first = std::max(row.begin, static_cast<int>(std::ceil(position - reach)));
  const int last = std::min(row.end - 1, static_cast<int>(std::floor(position + reach)));
  const int count = last - first + 1;
  if (count <= 4) return;
  const auto basis = [&](int c) {
    const double z = (c - position) / width;
    const double g = std::exp(-0.5 * z * z);
    return Eigen::Vector4d(1, g, z * g, z * z * g);
  };
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  double squares = 0;
  for (int c = first; c <= last; ++c) {
    const Eigen::Vector4d b = basis(c);
    const double s = row.at(c) - static_cast<double>(found.background);
    normal += b * b.transpose();
    right += s * b;
    squares += s * s;
  }
  const Eigen::Matrix4d inverse = normal.inverse();
  const double left = squares - right.dot(inverse * right);
  // Of each pixel's noise the fit leaves 1 - h, h its entry on the hat matrix's diagonal.
  double shares = 0;
  for (int c = first; c <= last; ++c) {
    const Eigen::Vector4d b = basis(c);
    shares += b[1] * (1 - b.dot(inverse * b));
  }
  found.residual = static_cast<float>(std::max(0.0, left) / (count - 4));
  found.residual_freedom = static_cast<float>(count - 4);
  found.residual_share = static_cast<float>(std::max(0.0, shares) / (count - 4));
}

}  // namespace facula
