// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/fir_zero_crossing.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace facula {
namespace {

/// A Gaussian and its first two derivatives, sampled at whole pixels -radius..radius.
struct Kernels {
  int radius = 0;
  std::vector<float> smooth;
  std::vector<float> slope;
  std::vector<float> curvature;
  float slope_norm = 0;      ///< noise gain of the slope [1]
  float curvature_norm = 0;  ///< noise gain of the curvature [1]
};

float norm(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v) * v;
  return static_cast<float>(std::sqrt(sum));
}

Kernels make_kernels(double sigma) {
  Kernels k;
  k.radius = std::max(2, static_cast<int>(std::ceil(4 * sigma)));
  double smooth_sum = 0;
  for (int i = -k.radius; i <= k.radius; ++i)
    smooth_sum += std::exp(-0.5 * i * i / (sigma * sigma));
  double curvature_sum = 0;
  for (int i = -k.radius; i <= k.radius; ++i) {
    const double g = std::exp(-0.5 * i * i / (sigma * sigma)) / smooth_sum;
    k.smooth.push_back(static_cast<float>(g));
    k.slope.push_back(static_cast<float>(i / (sigma * sigma) * g));
    k.curvature.push_back(static_cast<float>((1 - i * i / (sigma * sigma)) / (sigma * sigma) * g));
    curvature_sum += k.curvature.back();
  }
  // Sampling leaves a small mean, through which a bright surface would look like a line.
  for (std::size_t i = 0; i < k.curvature.size(); ++i) {
    k.curvature[i] -= static_cast<float>(curvature_sum) * k.smooth[i];
  }
  k.slope_norm = norm(k.slope);
  k.curvature_norm = norm(k.curvature);
  return k;
}

/// Sum of kernel times row about column c; beyond the borders the row goes on level.
float filtered(const std::vector<float>& kernel, const float* row, int c, int cols) {
  const int radius = static_cast<int>(kernel.size() / 2);
  float sum = 0;
  if (c >= radius && c + radius < cols) {
    const float* s = row + (c - radius);
    for (std::size_t i = 0; i < kernel.size(); ++i) sum += kernel[i] * s[i];
    return sum;
  }
  for (int i = -radius; i <= radius; ++i) {
    sum += kernel[static_cast<std::size_t>(i + radius)] * row[std::clamp(c + i, 0, cols - 1)];
  }
  return sum;
}

/// filtered() for all columns [begin, end): taps outside, columns inside, so that the compiler runs
/// several columns at once. The sums are the same.
std::vector<float> filtered_row(
    const std::vector<float>& kernel, const float* row, int begin, int end, int cols) {
  const int radius = static_cast<int>(kernel.size() / 2);
  std::vector<float> out(static_cast<std::size_t>(end - begin), 0.0F);
  const int first = std::clamp(radius, begin, end);
  const int last = std::clamp(cols - radius, first, end);
  for (int c = begin; c < first; ++c) {
    out[static_cast<std::size_t>(c - begin)] = filtered(kernel, row, c, cols);
  }
  for (int c = last; c < end; ++c) {
    out[static_cast<std::size_t>(c - begin)] = filtered(kernel, row, c, cols);
  }
  for (std::size_t i = 0; i < kernel.size() && first < last; ++i) {
    const float weight = kernel[i];
    const float* s = row + first - radius + static_cast<std::ptrdiff_t>(i);
    float* sum = out.data() + (first - begin);
    for (int c = 0; c < last - first; ++c) sum[c] += weight * s[c];
  }
  return out;
}

/// Standard deviation of most of the values, those within `reach` of `middle` left out: what else
/// is in the row beside the stripe: grain, compression, texture.
float robust_scale(const std::vector<float>& values, std::size_t middle, std::size_t reach) {
  std::vector<float> sizes;
  constexpr std::size_t kStep = 3;  // neighbours say the same after the filter
  for (std::size_t i = 0; i < values.size(); i += kStep) {
    if (i + reach < middle || i > middle + reach) sizes.push_back(std::abs(values[i]));
  }
  if (sizes.size() < 16) return 0;
  return median(sizes) * 1.4826F;  // sigma over the median of |x| for a normal x
}

class FirZeroCrossing : public RowDetector {
 public:
  explicit FirZeroCrossing(double sigma)
      : sigma_(static_cast<float>(sigma)), kernels_(make_kernels(sigma)) {}

  std::optional<StripeCandidate> find(const StripeSignal& signal,
                                      int r,
                                      int begin,
                                      int end) const override {
    if (end - begin < 3) return std::nullopt;
    const float* row = signal.row(r);
    const int cols = signal.cols();
    const std::vector<float> bends = filtered_row(kernels_.curvature, row, begin, end, cols);
    // The middle of the row's most line-like place is where the smoothed row bends most.
    const int peak =
        begin + static_cast<int>(std::max_element(bends.begin(), bends.end()) - bends.begin());
    const std::optional<float> position = zero_crossing(row, peak, begin, end, cols);
    if (!position) return std::nullopt;
    auto found = describe(signal, r, *position);
    if (found) {
      const std::size_t middle = static_cast<std::size_t>(peak - begin);
      const std::size_t reach = static_cast<std::size_t>(2 * kernels_.radius);
      found->row_noise = robust_scale(bends, middle, reach) / kernels_.curvature_norm;
    }
    return found;
  }

 private:
  /// The downward zero of the smoothed derivative nearest to `peak`, linear between two pixels.
  std::optional<float> zero_crossing(
      const float* row, int peak, int begin, int end, int cols) const {
    const int reach = std::max(2, static_cast<int>(std::lround(1.5F * sigma_)));
    std::optional<float> nearest;
    const int first = std::max(begin, peak - reach);
    const int last = std::min(end - 1, peak + reach);
    float left = filtered(kernels_.slope, row, first, cols);
    for (int c = first; c < last; ++c) {
      const float right = filtered(kernels_.slope, row, c + 1, cols);
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
  std::optional<StripeCandidate> describe(const StripeSignal& signal, int r, float position) const {
    const float* row = signal.row(r);
    const int cols = signal.cols();
    const int c = static_cast<int>(std::lround(position));
    const float bend = filtered(kernels_.curvature, row, c, cols);
    if (!(bend > 0)) return std::nullopt;
    StripeCandidate found;
    found.position = position;
    found.background = surroundings(row, c, cols);
    const float beside = filtered(kernels_.smooth, row, c, cols) - found.background;
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
    found.saturated = signal.clipped(r, std::clamp(c, 0, cols - 1));
    measure_misfit(row, cols, found);
    return found;
  }

  /// Mean level beside the stripe, 4 to 6 widths off on both sides.
  float surroundings(const float* row, int c, int cols) const {
    const int near = static_cast<int>(std::ceil(4 * sigma_));
    const int far = static_cast<int>(std::ceil(6 * sigma_));
    float sum = 0;
    int count = 0;
    for (int d = near; d <= far; ++d) {
      if (c - d >= 0) sum += row[c - d], ++count;
      if (c + d < cols) sum += row[c + d], ++count;
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
  static void measure_misfit(const float* row, int cols, StripeCandidate& found) {
    const float width = std::clamp(found.width, 0.5F, static_cast<float>(cols));
    const int first = std::max(0, static_cast<int>(std::ceil(found.position - 3 * width)));
    const int last = std::min(cols - 1, static_cast<int>(std::floor(found.position + 3 * width)));
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
      const double s = static_cast<double>(row[c]);
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
  Kernels kernels_;
};

}  // namespace

std::unique_ptr<RowDetector> make_fir_zero_crossing(double sigma) {
  return std::make_unique<FirZeroCrossing>(sigma);
}

}  // namespace facula
