// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/core/random.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace facula {

/// A line to be drawn by the tests' own formula: every pixel integrates the Gaussian over its
/// width.
struct LineImage {
  int rows = 400;
  int cols = 120;
  double sigma = 2;        ///< [px]
  double amplitude = 200;  ///< before clipping [DN]
  double noise = 2;        ///< [DN]
  double background = 10;  ///< [DN]
  double slope = 0;        ///< background per column [DN/px]
  std::function<double(int)> position = [](int r) { return 60 + 0.013 * r; };  ///< [px]
  std::uint64_t seed = 1;
};

inline Image8 draw(const LineImage& line) {
  Image8 image(line.rows, line.cols);
  for (int r = 0; r < line.rows; ++r) {
    Random random(line.seed, static_cast<std::uint64_t>(r));
    const double middle = line.position(r);
    for (int c = 0; c < line.cols; ++c) {
      const double root = std::sqrt(2.0) * line.sigma;
      const double share =
          0.5 * (std::erf((c + 0.5 - middle) / root) - std::erf((c - 0.5 - middle) / root));
      const double signal = line.background + line.slope * c +
                            line.amplitude * line.sigma * std::sqrt(2 * M_PI) * share +
                            line.noise * random.normal();
      image.row(r)[c] = static_cast<std::uint8_t>(std::lround(std::clamp(signal, 0.0, 255.0)));
    }
  }
  return image;
}

}  // namespace facula
