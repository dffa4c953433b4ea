// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/centroid.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace facula {
namespace {

constexpr int kReach = 10;  // [px], source B (2.3)

class Centroid : public RowDetector {
 public:
  std::optional<StripeCandidate> find(const StripeSignal& signal,
                                      int r,
                                      int begin,
                                      int end) const override {
    if (end - begin < 3) return std::nullopt;
    const float* row = signal.row(r);
    const float* brightest = std::max_element(row + begin, row + end);
    const int first = static_cast<int>(brightest - row);
    int last = first;
    for (int c = first; c < end; ++c) {
      if (row[c] == *brightest) last = c;
    }
    StripeCandidate found;
    std::vector<float> values(row + begin, row + end);
    found.background = median(values);
    found.amplitude = *brightest - found.background;
    const int middle = (first + last) / 2;
    weigh(row, std::max(begin, middle - kReach), std::min(end, middle + kReach + 1), found);
    found.saturated = signal.clipped(r, middle);
    found.snr_per_noise = found.amplitude;
    if (!(found.amplitude > 0) || !(found.sigma_per_noise > 0)) return std::nullopt;
    return found;
  }

 private:
  /// Mean m, spread, and what noise of 1 DN in every pixel does to the mean:
  /// sqrt(sum (x - m)^2) / sum I.
  static void weigh(const float* row, int begin, int end, StripeCandidate& found) {
    double weight = 0;
    double moment = 0;
    double square = 0;
    for (int c = begin; c < end; ++c) {
      const double w = std::max(0.0F, row[c] - found.background);
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
