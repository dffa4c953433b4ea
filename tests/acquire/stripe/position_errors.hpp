// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/tests/acquire/stripe/line_image.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace facula {

/// Errors of found positions against where the line was drawn.
struct PositionErrors {
  double squares = 0;  ///< [px^2]
  double sum = 0;      ///< [px]
  double chi2s = 0;    ///< sum of (error / sigma)^2 [1]
  double worst = 0;    ///< [px]
  int seen = 0;
  int rows = 0;

  double rms() const { return seen > 0 ? std::sqrt(squares / seen) : 0; }
  double bias() const { return seen > 0 ? sum / seen : 0; }
  double chi2() const { return seen > 0 ? chi2s / seen : 0; }
  double share_seen() const { return rows > 0 ? static_cast<double>(seen) / rows : 0; }

  void add(double error, double sigma) {
    squares += error * error;
    sum += error;
    chi2s += (error / sigma) * (error / sigma);
    worst = std::max(worst, std::abs(error));
    ++seen;
  }
};

/// Adds the rows of one drawn image that `counts` (all, where it is empty); where the image has two
/// lines the nearer one is meant.
inline void add_errors(const LineImage& line,
                       const StripeProfile& profile,
                       const std::function<bool(int)>& counts,
                       PositionErrors& errors) {
  for (int r = 0; r < line.rows; ++r) {
    if (counts && !counts(r)) continue;
    ++errors.rows;
    const auto i = static_cast<std::size_t>(r);
    if (profile.seen[i] == 0) continue;
    double error = static_cast<double>(profile.position[i]) - line.position(r);
    if (line.second_share) {
      const double other = error - line.second_offset;
      if (std::abs(other) < std::abs(error)) error = other;
    }
    errors.add(error, static_cast<double>(profile.sigma[i]));
  }
}

}  // namespace facula
