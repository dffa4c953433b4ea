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

}  // namespace

LineKernels line_kernels(double sigma) {
  LineKernels k;
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

}  // namespace facula
