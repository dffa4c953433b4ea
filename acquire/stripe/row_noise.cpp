// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/row_noise.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace facula {
namespace {

constexpr int kStripeReach = 10;  // a stripe's own columns beside its brightest pixel [px]

/// The sum of the `count` least of the values, which are 0 to 255.
int sum_of_least(std::vector<int>& values, std::size_t count) {
  const auto kept = values.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(values.begin(), kept, values.end());
  return std::accumulate(values.begin(), kept, 0);
}

/// Sizes of the second differences of a row, 255 at most, a stripe left out.
void differences_of(const SignalRow& row, std::vector<int>& differences) {
  const std::int16_t* s = row.values;
  const int cols = row.end - row.begin;
  const int brightest = static_cast<int>(std::max_element(s, s + cols) - s);
  differences.clear();
  for (int c = 1; c + 1 < cols; ++c) {
    if (std::abs(c - brightest) <= kStripeReach) continue;
    differences.push_back(std::min(255, std::abs(2 * s[c] - s[c - 1] - s[c + 1])));
  }
}

}  // namespace

float row_noise_from(int sum, int count) {
  // E|x| below its 75 % quantile is 0.5148 sigma for a normal x, whose sigma is sqrt(6) noise.
  return static_cast<float>(sum) / static_cast<float>(count) * (1 / (0.5148F * 2.4494897F));
}

int noise_row_step(int rows, int cols) {
  constexpr int kPixels = 10240;  // enough for noise to 2 %
  return std::max(1, rows / std::clamp(kPixels / cols, 8, 96));
}

float frame_noise_from(std::vector<float>& per_row) {
  constexpr float kQuantisation = 0.2886751F;  // 1 / sqrt(12)
  return per_row.empty() ? kQuantisation : std::max(kQuantisation, median(per_row));
}

float estimate_noise(const StripeSignal& signal) {
  std::vector<float> per_row;
  std::vector<int> differences;
  const int step = noise_row_step(signal.rows(), std::max(1, signal.cols()));
  for (int r = step / 2; r < signal.rows() && signal.cols() >= 8; r += step) {
    differences_of(signal.row(r), differences);
    // Whole numbers make the median of the sizes step by whole numbers; their upper quantile steps
    // as well, so the mean of the lower three quarters is taken instead.
    const std::size_t kept = differences.size() * 3 / 4;
    if (differences.size() < 4) continue;
    per_row.push_back(row_noise_from(sum_of_least(differences, kept), static_cast<int>(kept)));
  }
  return frame_noise_from(per_row);
}

}  // namespace facula
