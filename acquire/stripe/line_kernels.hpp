// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_signal.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// A Gaussian and its first two derivatives, sampled at whole pixels -radius..radius. The slope is
/// that of the smoothed row; the curvature has its sign turned, so that a bright line bends up.
struct LineKernels {
  int radius = 0;  ///< [px]
  std::vector<float> smooth;
  std::vector<float> slope;
  std::vector<float> curvature;
  float slope_norm = 0;      ///< noise gain of the slope [1]
  float curvature_norm = 0;  ///< noise gain of the curvature [1]
  float sigma = 0;           ///< [px]
};

/// Kernels of width `sigma` [px], out to 4 sigma.
LineKernels line_kernels(double sigma);

/// Sum of kernel times row about column c; beyond what is known the row goes on level.
float filtered(const std::vector<float>& kernel, const SignalRow& row, int c);

/// A kernel in whole numbers: sums over a row of whole DN are exact, in whatever order.
struct WholeKernel {
  std::vector<std::int16_t> weights;  ///< at -radius..radius, below 2^14
  float unit = 1;                     ///< value of a weight of 1: a power of two

  int radius() const { return static_cast<int>(weights.size() / 2); }
};

/// The three kernels of `sigma` to 14 bits. The smooth one sums to 1, the curvature to 0 and the
/// slope is odd, exactly.
struct WholeLineKernels {
  WholeKernel smooth;
  WholeKernel slope;
  WholeKernel curvature;
  float slope_norm = 0;      ///< noise gain of the slope [1]
  float curvature_norm = 0;  ///< noise gain of the curvature [1]
};

WholeLineKernels whole_line_kernels(double sigma);

/// Sum of weights times row about column c; beyond what is known the row goes on level.
std::int32_t weighed(const WholeKernel& kernel, const SignalRow& row, int c);

}  // namespace facula
