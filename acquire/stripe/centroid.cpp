// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/centroid.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace facula {
namespace {

constexpr int kReach = 10;  // [px], source B (2.3)

class Centroid : public RowDetector {
 public:
  std::optional<StripeCandidate> measure(const StripeSignal& signal,
                                         int r,
                                         int peak) const override {
    const SignalRow row = signal.row(r);
    // The brightest pixel near the peak; of equal ones the middle between the first and the last.
    int brightest = std::numeric_limits<int>::min();
    int first = peak;
    int last = peak;
    const int end = std::min(row.end, peak + kReach + 1);
    for (int c = std::max(row.begin, peak - kReach); c < end; ++c) {
      if (row.at(c) > brightest) {
        brightest = row.at(c);
        first = c;
      }
      if (row.at(c) == brightest) last = c;
    }
    StripeCandidate found;
    std::vector<std::int16_t> values(row.values, row.values + (row.end - row.begin));
    found.background = static_cast<float>(median(values));
    found.amplitude = static_cast<float>(brightest) - found.background;
    const int middle = (first + last) / 2;
    weigh(row, middle, found);
    found.saturated = row.is_clipped(middle);
    found.snr_per_noise = found.amplitude;
    if (!(found.amplitude > 0) || !(found.sigma_per_noise > 0)) return std::nullopt;
    return found;
  }

 private:
  /// Mean m, spread, and what noise of 1 DN in every pixel does to the mean:
  /// sqrt(sum (x - m)^2) / sum I.
  static void weigh(const SignalRow& row, int middle, StripeCandidate& found) {
    const int begin = std::max(row.begin, middle - kReach);
    const int end = std::min(row.end, middle + kReach + 1);
    double weight = 0;
    double moment = 0;
    double square = 0;
    for (int c = begin; c < end; ++c) {
      const double w = std::max(0.0F, static_cast<float>(row.at(c)) - found.background);
      weight += w;
      moment += w * c;
      square += w * c * c;
    }
    if (!(weight > 0)) return;
    const double mean = moment / weight;
    double lever = 0;
    for (int c = begin; c < end; ++c) lever += (c - mean) * (c - mean);
    found.position = static_cast<float>(mean);
    found.width = static_cast<float>(std::sqrt(std::max(0.0, square / weight - mean * mean)));
    found.sigma_per_noise = static_cast<float>(std::sqrt(lever) / weight);
  }
};

}  // namespace

std::unique_ptr<RowDetector> make_centroid() {
  return std::make_unique<Centroid>();
}

}  // namespace facula
