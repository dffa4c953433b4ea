// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/simulate/lens.hpp>
#include <facula/acquire/simulate/speckle_field.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace facula {
namespace {

constexpr double kMostFields = 16;  // beyond, contrast is under 1/4: fewer fields, less deep
constexpr double kDark = 1e-3;      // laser light that nobody could tell from none [DN]

// Weights that add up to 1 and whose squares add up to 1 / count, count being any number from 1:
// all but the last alike.
std::vector<double> field_weights(double count) {
  const auto n = static_cast<std::size_t>(std::ceil(count - 1e-9));
  if (n <= 1) return {1.0};
  const auto whole = static_cast<double>(n - 1);
  // whole a + b = 1 and whole a^2 + b^2 = 1 / count, the root with a >= b
  const double spread = std::sqrt(std::max((static_cast<double>(n) / count - 1) / whole, 0.0));
  const double a = (1 + spread) / static_cast<double>(n);
  std::vector<double> weights(n, a);
  weights.back() = 1 - whole * a;
  return weights;
}

// Correlation of the intensity at lag 1 of complex noise smoothed by blur_weights(sigma): the
// square of the field's, e^-2t I_1(2t) over e^-2t I_0(2t), as the blur applied twice has 2 t.
double smoothed_correlation(double sigma) {
  const std::vector<double> twice = blur_weights(std::sqrt(2.0) * sigma);
  const double field = twice.size() > 1 ? twice[1] / twice[0] : 0.0;
  return field * field;
}

double smoothing_for(double correlation) {
  double low = 0;
  double high = 30;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (smoothed_correlation(middle) < correlation ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Noise of variance 1/2, smoothed, and brought back to that variance. It is made with a margin: at
// its border a blur averages less.
Image<double> smooth_noise(int rows, int cols, double smoothing, Random& random) {
  const int margin = static_cast<int>(std::ceil(4 * smoothing));
  Image<double> noise(rows + 2 * margin, cols + 2 * margin);
  const double per_direction = blur_weights(std::sqrt(2.0) * smoothing)[0];
  const double scale = std::sqrt(0.5) / per_direction;
  for (double& value : noise.pixels) value = scale * random.normal();
  Lens lens;
  lens.blur = smoothing;
  spread_light(noise, lens);
  Image<double> inner(rows, cols);
  for (int r = 0; r < rows; ++r) std::copy_n(noise.row(r + margin) + margin, cols, inner.row(r));
  return inner;
}

}  // namespace

Image<double> speckle_field(int rows, int cols, const Speckle& speckle, std::uint64_t seed) {
  Image<double> field(rows, cols);
  const double contrast = speckle.contrast();
  const double count = std::clamp(1 / (contrast * contrast), 1.0, kMostFields);
  const double reach = contrast * std::sqrt(count);  // below 1 where fields are left out
  const double smoothing = smoothing_for(speckle.correlation(1));
  Random random(seed);
  for (const double weight : field_weights(count)) {
    for (int part = 0; part < 2; ++part) {  // real and imaginary
      const Image<double> noise = smooth_noise(rows, cols, smoothing, random);
      for (std::size_t i = 0; i < field.pixels.size(); ++i) {
        field.pixels[i] += weight * noise.pixels[i] * noise.pixels[i];
      }
    }
  }
  for (double& value : field.pixels) value = 1 + std::min(reach, 1.0) * (value - 1);
  return field;
}

void apply_speckle(Image<double>& laser, const Speckle& speckle, std::uint64_t seed) {
  int top = laser.rows;
  int bottom = 0;
  int left = laser.cols;
  int right = 0;
  for (int r = 0; r < laser.rows; ++r) {
    for (int c = 0; c < laser.cols; ++c) {
      if (laser.row(r)[c] < kDark) continue;
      top = std::min(top, r);
      bottom = r + 1;
      left = std::min(left, c);
      right = std::max(right, c + 1);
    }
  }
  if (bottom <= top) return;
  const Image<double> field = speckle_field(bottom - top, right - left, speckle, seed);
  for (int r = top; r < bottom; ++r) {
    for (int c = left; c < right; ++c) laser.row(r)[c] *= field.row(r - top)[c - left];
  }
}

std::uint64_t speckle_seed(std::uint64_t seed, const RigidTransform& world_from_camera) {
  std::uint64_t mixed = seed;
  const auto stir = [&](double value) {
    mixed = Random(mixed ^ std::bit_cast<std::uint64_t>(value + 0.0), 77).bits();
  };
  for (const double value : world_from_camera.translation) stir(value);
  for (const double value : world_from_camera.rotation.coeffs()) stir(value);
  return mixed;
}

}  // namespace facula
