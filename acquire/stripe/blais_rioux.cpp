// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/blais_rioux.hpp>
#include <facula/acquire/stripe/line_bias.hpp>
#include <facula/acquire/stripe/peak_detector.hpp>
#include <facula/acquire/stripe/position_noise.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

class BlaisRioux : public PeakDetector {
 public:
  BlaisRioux(double sigma, int taps) : PeakDetector(sigma), half_(taps / 2) {
    require(taps >= 2 && taps % 2 == 0,
            "Blais-Rioux detector: expected an even number of taps, at least 2, got ",
            taps);
  }

 private:
  bool place(const Peak& peak, StripeCandidate& found) const override {
    const SignalRow& row = peak.row;
    const PeakShape& shape = peak.shape;
    const auto zero = nearest_zero(row, shape);
    if (!zero) return false;
    found.position = static_cast<float>(zero->column + zero->share());
    carry_noise(row, *zero, shape.background, found);
    const double width = std::max(0.5, static_cast<double>(found.width));
    found.sigma_step =
        static_cast<float>(rms_bias([&](double place) { return bias(width, place); }));
    return true;
  }

  /// The sum crosses zero downwards between column and column + 1.
  struct Zero {
    int column = 0;
    double left = 0;   ///< [DN]
    double right = 0;  ///< [DN]
    double share() const { return left / (left - right); }
  };

  /// Right less left: above 0 where the row rises.
  template <typename Values>
  double difference(const Values& at, int c) const {
    double sum = 0;
    for (int i = 1; i <= half_; ++i) sum += at(c + i) - at(c - i);
    return sum;
  }

  template <typename Values>
  std::optional<Zero> zero_at(const Values& at, int c) const {
    const Zero zero = {c, difference(at, c), difference(at, c + 1)};
    if (!(zero.left > 0 && zero.right <= 0)) return std::nullopt;
    return zero;
  }

  std::optional<Zero> nearest_zero(const SignalRow& row, const PeakShape& shape) const {
    const auto at = [&](int c) { return static_cast<double>(row.at(c)); };
    const int reach = half_ + (shape.last - shape.first) / 2 + 1;
    const double middle = 0.5 * (shape.first + shape.last);
    std::optional<Zero> nearest;
    const int end = std::min(row.end - 1, shape.middle() + reach);
    for (int c = std::max(row.begin, shape.middle() - reach); c < end; ++c) {
      const auto zero = zero_at(at, c);
      if (!zero) continue;
      if (!nearest || std::abs(c + zero->share() - middle) <
                          std::abs(nearest->column + nearest->share() - middle)) {
        nearest = zero;
      }
    }
    return nearest;
  }

  /// Each pixel's weight in the two sums, +1 right of and -1 left of the pixel itself.
  void carry_noise(const SignalRow& row,
                   const Zero& zero,
                   double background,
                   StripeCandidate& found) const {
    const auto tap = [&](int d) {
      if (d == 0 || std::abs(d) > half_) return 0.0;
      return d > 0 ? 1.0 : -1.0;
    };
    const double t = zero.share();
    PositionNoise noise;
    for (int d = -half_; d <= half_ + 1; ++d) {
      const double weight = ((1 - t) * tap(d) + t * tap(d - 1)) / (zero.left - zero.right);
      noise.add(weight, row.at(zero.column + d) - background);
    }
    noise.store(found);
  }

  /// Of a sampled Gaussian line that lies `place` beside a pixel's middle.
  double bias(double width, double place) const {
    const auto at = [&](int c) {
      const double z = (c - place) / width;
      return std::exp(-0.5 * z * z);
    };
    for (const int c : {-1, 0}) {
      if (const auto zero = zero_at(at, c)) return c + zero->share() - place;
    }
    return 0;
  }

  int half_;
};

}  // namespace

std::unique_ptr<RowDetector> make_blais_rioux(double sigma, int taps) {
  return std::make_unique<BlaisRioux>(sigma, taps);
}

}  // namespace facula
