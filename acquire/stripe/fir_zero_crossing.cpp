// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/fir_clipped.hpp>
#include <facula/acquire/stripe/fir_shape.hpp>
#include <facula/acquire/stripe/fir_zero_crossing.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace facula {
namespace {

class FirZeroCrossing : public RowDetector {
 public:
  explicit FirZeroCrossing(double sigma) : shape_(fir_shape(sigma)) {}

  std::optional<StripeCandidate> measure(const StripeSignal& signal,
                                         int r,
                                         int peak) const override {
    const SignalRow row = signal.row(r);
    const std::optional<Crossing> crossing = find_crossing(row, peak);
    if (!crossing) return std::nullopt;
    return describe(row, peak, *crossing);
  }

 private:
  /// Where the slope goes from above 0 to 0 or below, between two neighbouring columns.
  struct Crossing {
    float from = 0;   ///< column of the left one less the peak [px]
    float left = 0;   ///< slope there, in weights
    float right = 0;  ///< slope one column on
  };

  /// The one nearest to the peak, up to two columns off.
  std::optional<Crossing> find_crossing(const SignalRow& row, int peak) const {
    std::int32_t slope[5];
    for (int i = 0; i < 5; ++i) slope[i] = weighed(shape_.kernels.slope, row, peak + i - 2);
    for (const int i : {1, 2, 0, 3}) {
      if (slope[i] > 0 && slope[i + 1] <= 0) {
        return Crossing{static_cast<float>(i - 2),
                        static_cast<float>(slope[i]),
                        static_cast<float>(slope[i + 1])};
      }
    }
    return std::nullopt;
  }

  /// Amplitude, width, uncertainty and misfit. With P the smoothed height and L the smoothed bend
  /// of a Gaussian line of width w, d beside its middle, and v = w^2 + sigma^2:
  /// P = P0 exp(-d^2 / 2v) and P / L = v / (1 - d^2 / v). The slope goes as x (1 - x^2 / 2v), so
  /// that a straight line through two neighbours crosses zero t (1 - t) (1 - 2t) / 2v too far.
  /// Every operation is written out in the order in which fir_simd.cpp does it for many rows.
  std::optional<StripeCandidate> describe(const SignalRow& row, int peak, Crossing crossing) const {
    const FirShape& s = shape_;
    const float level = static_cast<float>(sum_beside(row, peak)) * s.per_background_pixel;
    const float height =
        static_cast<float>(weighed(s.kernels.smooth, row, peak)) * s.smooth_unit - level;
    const float bend = static_cast<float>(weighed(s.kernels.curvature, row, peak)) * s.bend_unit;
    if (!(bend > 0)) return std::nullopt;
    const float drop = crossing.left - crossing.right;
    const float per_both = 1 / (drop * bend);
    const float t = crossing.left * bend * per_both;
    const float d0 = crossing.from + t;
    const float ratio = height * drop * per_both;
    const float root = std::sqrt(std::max(0.0F, ratio * ratio - 4 * ratio * (d0 * d0)));
    const float variance = 0.5F * (ratio + root);
    if (!(variance > 0)) return std::nullopt;
    const float inverse = 1 / variance;
    const float d = d0 - 0.5F * inverse * (t * (1 - t) * (1 - 2 * t));
    const float top = height * exp_near_zero(0.5F * (d * d) * inverse);
    const float top_bend = top * inverse;
    const float width2 = std::max(0.0F, variance - s.sigma2);
    // The filter's slope squared goes as x^2 exp(-x^2 / sigma^2), the line as exp(-x^2 / 2 w^2):
    // the integral of their product over the first's is (1 + sigma^2 / 2 w^2)^(-3/2).
    const float drawn2 = std::max(s.least_width2, width2);
    const float wider2 = drawn2 + 0.5F * s.sigma2;
    const float per_all = 1 / (drawn2 * wider2 * top_bend);
    const float per_width2 = wider2 * top_bend * per_all;
    const float share = drawn2 * drawn2 * top_bend * per_all;
    StripeCandidate found;
    found.position = static_cast<float>(peak) + d;
    found.background = level;
    found.width = std::sqrt(width2);
    found.amplitude = width2 > 0 ? top * std::sqrt(variance * per_width2) : 0;
    found.snr_per_noise = top_bend * s.per_bend_noise;
    found.sigma_per_noise = s.slope_noise * (drawn2 * wider2) * per_all;
    found.position_share = share * std::sqrt(share);
    found.saturated = row.is_clipped(static_cast<int>(std::floor(found.position + 0.5F)));
    measure_misfit(row, peak, d, 0.5F * per_width2, found);
    if (found.saturated) judge_clipped(row, s.sigma, top_bend, found);
    return found;
  }

  std::int32_t sum_beside(const SignalRow& row, int peak) const {
    std::int32_t sum = 0;
    for (int i = shape_.background_from; i <= shape_.background_to; ++i) {
      sum += row.at(peak - i) + row.at(peak + i);
    }
    return sum;
  }

  /// Mean square that a Gaussian of the found position and width leaves over +-3 sigma about the
  /// peak, its height and level fitted by least squares; four parameters taken off. `q` is half
  /// over the square of the width. A Gaussian at equal steps: each value is the one before times a
  /// factor that itself changes by a constant factor.
  void measure_misfit(
      const SignalRow& row, int peak, float d, float q, StripeCandidate& found) const {
    const int reach = shape_.misfit_reach;
    const float change = exp_near_zero(-2 * q);
    const float middle = exp_near_zero(-(d * d) * q);
    float sum_g = middle;
    float sum_gg = middle * middle;
    float sum_gs = middle * static_cast<float>(row.at(peak));
    float right = middle;
    float left = middle;
    float right_factor = exp_near_zero(-q * (1 - 2 * d));
    float left_factor = exp_near_zero(-q * (1 + 2 * d));
    const auto add = [&](float& g, float& factor, int c) {
      g = g * factor;
      factor = factor * change;
      sum_g = sum_g + g;
      sum_gg = sum_gg + g * g;
      sum_gs = sum_gs + g * static_cast<float>(row.at(c));
    };
    for (int i = 1; i <= reach; ++i) {
      add(right, right_factor, peak + i);
      add(left, left_factor, peak - i);
    }
    std::int32_t sum = 0;
    std::int32_t squares = 0;
    for (int i = -reach; i <= reach; ++i) {
      sum += row.at(peak + i);
      squares += row.at(peak + i) * row.at(peak + i);
    }
    const float per_pixel = shape_.per_misfit_pixel;
    const auto s1 = static_cast<float>(sum);
    const float spread = sum_gg - sum_g * sum_g * per_pixel;
    const float together = sum_gs - sum_g * s1 * per_pixel;
    // In whole numbers: the difference of two large ones.
    const float scatter = static_cast<float>(squares * (2 * reach + 1) - sum * sum) * per_pixel;
    const float rest = scatter - together * together / spread;
    found.residual = std::max(0.0F, rest) * shape_.per_misfit_freedom;
    found.residual_freedom = shape_.misfit_freedom();
    found.residual_share = sum_g * per_pixel;
  }

  FirShape shape_;
};

}  // namespace

FirShape fir_shape(double sigma) {
  FirShape s;
  s.kernels = whole_line_kernels(sigma);
  s.smooth_unit = s.kernels.smooth.unit;
  s.bend_unit = s.kernels.curvature.unit;
  s.sigma = static_cast<float>(sigma);
  s.sigma2 = static_cast<float>(sigma * sigma);
  s.least_width2 = std::max(0.25F, 0.25F * s.sigma2);
  s.per_bend_noise = 1 / s.kernels.curvature_norm;
  s.slope_noise = s.kernels.slope_norm;
  s.background_from = static_cast<int>(std::ceil(4 * sigma));
  s.background_to = static_cast<int>(std::ceil(5.5 * sigma));
  s.per_background_pixel = 0.5F / static_cast<float>(s.background_to - s.background_from + 1);
  s.misfit_reach = std::max(6, static_cast<int>(std::lround(3 * sigma)));
  s.per_misfit_pixel = 1 / static_cast<float>(2 * s.misfit_reach + 1);
  s.per_misfit_freedom = 1 / s.misfit_freedom();
  return s;
}

std::unique_ptr<RowDetector> make_fir_zero_crossing(double sigma) {
  return std::make_unique<FirZeroCrossing>(sigma);
}

}  // namespace facula
