// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/fir_zero_crossing.hpp>
#include <facula/acquire/stripe/line_kernels.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace facula {
namespace {

class FirZeroCrossing : public RowDetector {
 public:
  explicit FirZeroCrossing(double sigma)
      : sigma_(static_cast<float>(sigma)), kernels_(line_kernels(sigma)) {}

  std::optional<StripeCandidate> measure(const StripeSignal& signal,
                                         int r,
                                         int peak) const override {
    const SignalRow row = signal.row(r);
    const std::optional<float> position = zero_crossing(row, peak);
    if (!position) return std::nullopt;
    return describe(row, *position);
  }

 private:
  /// The downward zero of the smoothed derivative nearest to `peak`, linear between two pixels.
  std::optional<float> zero_crossing(const SignalRow& row, int peak) const {
    const int reach = std::max(2, static_cast<int>(std::lround(1.5F * sigma_)));
    std::optional<float> nearest;
    const int first = std::max(row.begin, peak - reach);
    const int last = std::min(row.end - 1, peak + reach);
    float left = filtered(kernels_.slope, row, first);
    for (int c = first; c < last; ++c) {
      const float right = filtered(kernels_.slope, row, c + 1);
      if (left > 0 && right <= 0) {
        const float zero = static_cast<float>(c) + left / (left - right);
        if (!nearest || std::abs(zero - static_cast<float>(peak)) <
                            std::abs(*nearest - static_cast<float>(peak))) {
          nearest = zero;
        }
      }
      left = right;
    }
    return nearest;
  }

  /// Amplitude, width, uncertainty and misfit at the position found. With P the smoothed height and
  /// L the smoothed bend of a Gaussian line of width w, d beside its middle, and v = w^2 + sigma^2:
  /// P = P0 exp(-d^2 / 2v) and P / L = v / (1 - d^2 / v).
  std::optional<StripeCandidate> describe(const SignalRow& row, float position) const {
    const int c = static_cast<int>(std::lround(position));
    const float bend = filtered(kernels_.curvature, row, c);
    if (!(bend > 0)) return std::nullopt;
    StripeCandidate found;
    found.position = position;
    found.background = surroundings(row, c);
    const float beside = filtered(kernels_.smooth, row, c) - found.background;
    const float ratio = beside / bend;
    const float d2 = (position - static_cast<float>(c)) * (position - static_cast<float>(c));
    const float variance =
        0.5F * (ratio + std::sqrt(std::max(0.0F, ratio * ratio - 4 * ratio * d2)));
    if (!(variance > 0)) return std::nullopt;
    const float height = beside * std::exp(0.5F * d2 / variance);
    const float top_bend = height / variance;
    found.width = std::sqrt(std::max(0.0F, variance - sigma_ * sigma_));
    found.amplitude = found.width > 0 ? height * std::sqrt(variance) / found.width : 0;
    found.snr_per_noise = top_bend / kernels_.curvature_norm;
    found.sigma_per_noise = kernels_.slope_norm / top_bend;
    found.position_share = position_share(found.width);
    found.saturated = row.is_clipped(c);
    measure_misfit(row, found);
    return found;
  }

  /// Mean level beside the stripe, 4 to 6 widths off on both sides.
  float surroundings(const SignalRow& row, int c) const {
    const int near = static_cast<int>(std::ceil(4 * sigma_));
    const int far = static_cast<int>(std::ceil(6 * sigma_));
    float sum = 0;
    int count = 0;
    for (int d = near; d <= far; ++d) {
      if (row.holds(c - d)) sum += static_cast<float>(row.at(c - d)), ++count;
      if (row.holds(c + d)) sum += static_cast<float>(row.at(c + d)), ++count;
    }
    return count > 0 ? sum / static_cast<float>(count) : 0;
  }

  /// The filter's slope squared goes as x^2 exp(-x^2 / sigma^2), the line as exp(-x^2 / 2 w^2): the
  /// integral of their product over that of the first is (1 + sigma^2 / 2 w^2)^(-3/2).
  float position_share(float width) const {
    const float w = std::max(0.5F, width);
    return std::pow(1 + sigma_ * sigma_ / (2 * w * w), -1.5F);
  }

  /// Mean square that a Gaussian of the found position and width leaves over +-3 widths, its height
  /// and level fitted by least squares; four parameters taken off.
  static void measure_misfit(const SignalRow& row, StripeCandidate& found) {
    const float width = std::clamp(found.width, 0.5F, static_cast<float>(row.end));
    const int first = std::max(row.begin, static_cast<int>(std::ceil(found.position - 3 * width)));
    const int last =
        std::min(row.end - 1, static_cast<int>(std::floor(found.position + 3 * width)));
    const int count = last - first + 1;
    if (count <= 4) return;
    double g1 = 0;
    double g2 = 0;
    double s1 = 0;
    double s2 = 0;
    double gs = 0;
    for (int c = first; c <= last; ++c) {
      const double z = static_cast<double>((static_cast<float>(c) - found.position) / width);
      const double g = std::exp(-0.5 * z * z);
      const double s = static_cast<double>(row.at(c));
      g1 += g;
      g2 += g * g;
      s1 += s;
      s2 += s * s;
      gs += g * s;
    }
    const double spread = g2 - g1 * g1 / count;
    const double covariance = gs - g1 * s1 / count;
    const double left = s2 - s1 * s1 / count - covariance * covariance / spread;
    found.residual = static_cast<float>(std::max(0.0, left) / (count - 4));
    found.residual_share = static_cast<float>(g1 / count);
  }

  float sigma_;
  LineKernels kernels_;
};

}  // namespace

std::unique_ptr<RowDetector> make_fir_zero_crossing(double sigma) {
  return std::make_unique<FirZeroCrossing>(sigma);
}

}  // namespace facula
