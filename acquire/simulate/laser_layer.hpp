// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/simulate/conditions.hpp>

namespace facula {

/// The laser's light on the sensor. A lens blurs the light before the pixels sum it up: a line that
/// is thinner than a pixel must not lose its place within the pixel first. Under a lens that blurs
/// enough, every spot of light is therefore laid onto the 4 x 4 pixels about it with the weights of
/// the cubic B-spline, which keep its place exactly and widen it by a variance of 1/3 px^2 wherever
/// it lies (Unser 1999); the blur that follows is narrower by as much, less the pixel's own extent.
class LaserLayer {
 public:
  /// Empty where the laser is off.
  LaserLayer() = default;
  LaserLayer(int rows, int cols, const Lens& lens);

  bool empty() const { return light_.empty(); }

  /// Light of a spot `across` and `down` from the middle of pixel (r, c), within +-0.5 [px, DN].
  void add(int r, int c, double across, double down, double light);

  /// The light after the lens [DN].
  Image<double> spread() &&;

 private:
  Image<double> light_;
  Lens lens_;
  bool fine_ = false;
};

}  // namespace facula
