// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/row_noise.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace facula {
namespace {

constexpr float kQuantisation = 0.2886751F;  // 1 / sqrt(12)
constexpr int kRows = 96;                    // rows looked at: enough for a median to 1 %
constexpr int kStripeReach = 10;             // a stripe's own rows beside its brightest pixel [px]

}  // namespace

float estimate_noise(const StripeSignal& signal) {
  if (signal.cols() < 8 || signal.rows() == 0) return kQuantisation;
  std::vector<float> per_row;
  std::vector<float> differences;
  const int step = std::max(1, signal.rows() / kRows);
  for (int r = 0; r < signal.rows(); r += step) {
    const std::int16_t* s = signal.row(r).values;
    differences.clear();
    // Whole numbers make the median of |differences| step by whole numbers; their upper quantile
    // steps as well, so the mean of the lower three quarters is taken instead.
    const int brightest = static_cast<int>(std::max_element(s, s + signal.cols()) - s);
    for (int c = 1; c + 1 < signal.cols(); ++c) {
      if (std::abs(c - brightest) <= kStripeReach) continue;
      differences.push_back(static_cast<float>(std::abs(2 * s[c] - s[c - 1] - s[c + 1])));
    }
    if (differences.size() < 4) continue;
    const std::size_t kept = differences.size() * 3 / 4;
    std::nth_element(differences.begin(),
                     differences.begin() + static_cast<std::ptrdiff_t>(kept),
                     differences.end());
    double sum = 0;
    for (std::size_t i = 0; i < kept; ++i) sum += differences[i];
    // E|x| below its 75 % quantile is 0.5148 sigma for a normal x, whose sigma is sqrt(6) noise.
    per_row.push_back(static_cast<float>(sum / static_cast<double>(kept)) / (0.5148F * 2.4494897F));
  }
  if (per_row.empty()) return kQuantisation;
  return std::max(kQuantisation, median(per_row));
}

}  // namespace facula
