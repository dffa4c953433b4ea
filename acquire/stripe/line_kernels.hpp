// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_signal.hpp>

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
};

/// Kernels of width `sigma` [px], out to 4 sigma.
LineKernels line_kernels(double sigma);

/// Sum of kernel times row about column c; beyond what is known the row goes on level.
float filtered(const std::vector<float>& kernel, const SignalRow& row, int c);

}  // namespace facula
