// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/laser_layer.hpp>
#include <facula/acquire/simulate/lens.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace facula {
namespace {

// What the spline adds beyond the pixel's own extent, which counts between spots 1/4 px apart only:
// 1/12 - 1/192 [px^2].
constexpr double kSplineExcess = 1.0 / 3 - (1.0 / 12 - 1.0 / 192);

// Cubic B-spline at -1 - t, -t, 1 - t, 2 - t for t in [0, 1).
std::array<double, 4> spline_weights(double t) {
  const double s = 1 - t;
  return {s * s * s / 6,
          (4 - 6 * t * t + 3 * t * t * t) / 6,
          (4 - 6 * s * s + 3 * s * s * s) / 6,
          t * t * t / 6};
}

}  // namespace

LaserLayer::LaserLayer(int rows, int cols, const Lens& lens)
    : light_(rows, cols), lens_(lens), fine_(lens.blur * lens.blur > kSplineExcess + 0.1) {
  if (fine_) lens_.blur = std::sqrt(lens.blur * lens.blur - kSplineExcess);
}

void LaserLayer::add(int r, int c, double across, double down, double light) {
  if (light == 0) return;
  if (!fine_) {
    light_.row(r)[c] += light;
    return;
  }
  const int right = across < 0 ? -1 : 0;
  const int below = down < 0 ? -1 : 0;
  const std::array<double, 4> x = spline_weights(across - right);
  const std::array<double, 4> y = spline_weights(down - below);
  for (int j = 0; j < 4; ++j) {
    double* row = light_.row(std::clamp(r + below + j - 1, 0, light_.rows - 1));
    for (int i = 0; i < 4; ++i) {
      const int col = std::clamp(c + right + i - 1, 0, light_.cols - 1);
      row[col] += light * x[static_cast<std::size_t>(i)] * y[static_cast<std::size_t>(j)];
    }
  }
}

Image<double> LaserLayer::spread() && {
  spread_light(light_, lens_);
  return std::move(light_);
}

}  // namespace facula
