// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/profile/profile_bench.hpp>

#include <cmath>
#include <numbers>

namespace facula {

double ProfileBench::height(double shift) const {
  const double secant = 1 / std::cos(angle);
  return baseline * shift * secant * secant / (lens_to_sensor + shift * std::tan(angle));
}

double ProfileBench::shift(double height) const {
  const double secant = 1 / std::cos(angle);
  return height * lens_to_sensor / (baseline * secant * secant - height * std::tan(angle));
}

void ProfileBench::check() const {
  require(baseline > 0 && lens_to_sensor > 0,
          "expected baseline and lens-to-sensor distance above 0 mm, got ",
          1000 * baseline,
          " and ",
          1000 * lens_to_sensor);
  require(angle > 0 && angle < std::numbers::pi / 2,
          "expected an angle of 0 to 90 degrees between baseline and optical axis, got ",
          angle * 180 / std::numbers::pi);
}

}  // namespace facula
