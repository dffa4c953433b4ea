// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/simulate/sensor.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

std::uint8_t digitised(double value) {
  return static_cast<std::uint8_t>(std::floor(std::clamp(value, 0.0, 255.0) + 0.5));
}

}  // namespace

Image8 sensed(const Image<double>& light, const SimulateOptions& options, std::uint64_t exposure) {
  Image8 image(light.rows, light.cols, light.channels);
  const double read_variance = options.read_noise * options.read_noise;
  for (int r = 0; r < light.rows; ++r) {
    Random random(
        options.seed,
        exposure * static_cast<std::uint64_t>(light.rows) + static_cast<std::uint64_t>(r));
    const double* in = light.row(r);
    std::uint8_t* out = image.row(r);
    for (std::ptrdiff_t i = 0; i < light.stride(); ++i) {
      const double noise = std::sqrt(read_variance + options.shot_noise * in[i]);
      out[i] = digitised(options.black_level + in[i] + noise * random.normal());
    }
  }
  return image;
}

}  // namespace facula
