// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/line_kernels.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

float norm(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v) * v;
  return static_cast<float>(std::sqrt(sum));
}

float norm(const WholeKernel& kernel) {
  double sum = 0;
  for (const std::int16_t w : kernel.weights) sum += static_cast<double>(w) * w;
  return static_cast<float>(std::sqrt(sum)) * kernel.unit;
}

/// Rounds to the finest power of two that keeps every weight below 2^14; where `fix_sum`, the
/// middle weight takes up what rounding did to the sum.
WholeKernel whole(const std::vector<float>& exact, bool fix_sum, int wanted_sum) {
  float largest = 0;
  for (const float v : exact) largest = std::max(largest, std::abs(v));
  const int exponent = 13 - std::ilogb(largest);
  WholeKernel kernel;
  kernel.unit = std::ldexp(1.0F, -exponent);
  int sum = 0;
  for (const float v : exact) {
    kernel.weights.push_back(static_cast<std::int16_t>(std::lround(std::ldexp(v, exponent))));
    sum += kernel.weights.back();
  }
  if (fix_sum) {
    std::int16_t& middle = kernel.weights[kernel.weights.size() / 2];
    middle = static_cast<std::int16_t>(middle + wanted_sum * (1 << exponent) - sum);
  }
  return kernel;
}

}  // namespace

LineKernels line_kernels(double sigma) {
  LineKernels k;
  k.sigma = static_cast<float>(sigma);
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

float filtered(const std::vector<float>& kernel, const SignalRow& row, int c) {
  const int radius = static_cast<int>(kernel.size() / 2);
  float sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    sum += kernel[static_cast<std::size_t>(i + radius)] * static_cast<float>(row.at(c + i));
  }
  return sum;
}

WholeLineKernels whole_line_kernels(double sigma) {
  const LineKernels exact = line_kernels(sigma);
  WholeLineKernels k;
  k.smooth = whole(exact.smooth, true, 1);
  k.slope = whole(exact.slope, false, 0);
  k.curvature = whole(exact.curvature, true, 0);
  k.slope_norm = norm(k.slope);
  k.curvature_norm = norm(k.curvature);
  return k;
}

std::int32_t weighed(const WholeKernel& kernel, const SignalRow& row, int c) {
  const int radius = kernel.radius();
  std::int32_t sum = 0;
  for (int i = -radius; i <= radius; ++i) {
    sum += std::int32_t{kernel.weights[static_cast<std::size_t>(i + radius)]} * row.at(c + i);
  }
  return sum;
}

}  // namespace facula
