// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/core/random.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace facula {

using Colour = std::array<double, 3>;  // blue, green, red [DN]

/// A colour picture drawn by the tests' own formulas: light is added up, noise put on, and the sum
/// clipped, so that a strong line has a white core and a halo of its own colour.
class LitScene {
 public:
  LitScene(int rows, int cols, const Colour& wall)
      : rows_(rows),
        cols_(cols),
        light_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols), wall) {}

  int rows() const { return rows_; }
  int cols() const { return cols_; }

  /// Adds a Gaussian ridge of `colour` at its top along x = position(r), rows [first, last).
  LitScene& ridge(const std::function<double(int)>& position,
                  double sigma,
                  const Colour& colour,
                  int first = 0,
                  int last = 1 << 30) {
    for (int r = std::max(0, first); r < std::min(rows_, last); ++r) {
      for (int c = 0; c < cols_; ++c) {
        const double z = (c - position(r)) / sigma;
        add(r, c, colour, std::exp(-0.5 * z * z));
      }
    }
    return *this;
  }

  /// Paints rows [y, y + height) of columns [x, x + width) in one colour.
  LitScene& paint(int x, int y, int width, int height, const Colour& colour) {
    for (int r = y; r < std::min(rows_, y + height); ++r) {
      for (int c = x; c < std::min(cols_, x + width); ++c) at(r, c) = colour;
    }
    return *this;
  }

  /// Multiplies rows by factor(r).
  LitScene& dim(const std::function<double(int)>& factor) {
    for (int r = 0; r < rows_; ++r) {
      for (int c = 0; c < cols_; ++c) {
        for (double& value : at(r, c)) value *= factor(r);
      }
    }
    return *this;
  }

  /// The picture a camera takes; light beyond the red's end spills into the other colours, as it
  /// does where a sensor's filters overlap.
  Image8 picture(double noise, std::uint64_t seed, double spill = 0.35) const {
    Image8 image(rows_, cols_, 3);
    for (int r = 0; r < rows_; ++r) {
      Random random(seed, static_cast<std::uint64_t>(r));
      for (int c = 0; c < cols_; ++c) {
        Colour value = light_[index(r, c)];
        const double over = std::max(0.0, value[2] - 255);
        value[0] += spill * over;
        value[1] += spill * over;
        for (std::size_t k = 0; k < 3; ++k) {
          const double seen = std::clamp(value[k] + noise * random.normal(), 0.0, 255.0);
          image.row(r)[3 * c + static_cast<int>(k)] = static_cast<std::uint8_t>(std::lround(seen));
        }
      }
    }
    return image;
  }

 private:
  std::size_t index(int r, int c) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(cols_) +
           static_cast<std::size_t>(c);
  }
  Colour& at(int r, int c) { return light_[index(r, c)]; }
  void add(int r, int c, const Colour& colour, double share) {
    for (std::size_t k = 0; k < 3; ++k) at(r, c)[k] += share * colour[k];
  }

  int rows_;
  int cols_;
  std::vector<Colour> light_;
};

}  // namespace facula
