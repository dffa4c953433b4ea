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
  double photons = 0;        ///< variance per DN of the line's own light [DN]
  double second_offset = 0;  ///< of a second line of the same shape beside the first [px]
  std::function<double(int)> second_share;  ///< part of the light that lies in it, if any [1]
  std::uint64_t seed = 1;
};

/// Mean over pixel c of a line of height 1 at `middle`.
inline double line_in_pixel(double sigma, double middle, int c) {
  const double root = std::sqrt(2.0) * sigma;
  const double share =
      0.5 * (std::erf((c + 0.5 - middle) / root) - std::erf((c - 0.5 - middle) / root));
  return sigma * std::sqrt(2 * M_PI) * share;
}

inline Image8 draw(const LineImage& line) {
  Image8 image(line.rows, line.cols);
  for (int r = 0; r < line.rows; ++r) {
    Random random(line.seed, static_cast<std::uint64_t>(r));
    const double middle = line.position(r);
    const double second = line.second_share ? line.second_share(r) : 0;
    for (int c = 0; c < line.cols; ++c) {
      double light = (1 - second) * line.amplitude * line_in_pixel(line.sigma, middle, c);
      if (second > 0) {
        light +=
            second * line.amplitude * line_in_pixel(line.sigma, middle + line.second_offset, c);
      }
      const double noise = std::sqrt(line.noise * line.noise + line.photons * light);
      const double signal = line.background + line.slope * c + light + noise * random.normal();
      image.row(r)[c] = static_cast<std::uint8_t>(std::lround(std::clamp(signal, 0.0, 255.0)));
    }
  }
  return image;
}

}  // namespace facula
