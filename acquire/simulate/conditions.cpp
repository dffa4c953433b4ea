// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/conditions.hpp>

#include <cmath>
#include <numbers>

namespace facula {
namespace {

// Width of the speckle field's intensity correlation exp(-d^2 / (2 s^2)) in grains: its area
// 2 pi s^2 is that of a round aperture's grain, 4 / pi (lambda N (1 + m))^2 (Goodman 2007, 4.4).
const double kWidthPerGrain = std::sqrt(2.0) / std::numbers::pi;

// Integral of (1 - |t|) exp(-(t - distance)^2 / (2 s^2)) over |t| < 1: what two pixels of size 1
// that are `distance` apart have in common, along one direction. Simpson's rule; the kink at 0 and
// the ends lie on its nodes.
double overlap(double distance, double s) {
  if (s < 1e-3) return distance < 1 ? (1 - distance) * s * std::sqrt(2 * std::numbers::pi) : 0.0;
  const int half = 2 * static_cast<int>(std::ceil(8 / std::min(s, 1.0)));
  double sum = 0;
  for (int i = -half; i <= half; ++i) {
    const double t = static_cast<double>(i) / half;
    const double weight = i == -half || i == half ? 1 : i % 2 == 0 ? 2 : 4;
    const double u = (t - distance) / s;
    sum += weight * (1 - std::abs(t)) * std::exp(-0.5 * u * u);
  }
  return sum / (3.0 * half);
}

}  // namespace

double GaussianBeam::half_width(double from_laser) const {
  const double rayleigh = std::numbers::pi * waist * waist / (quality * wavelength);
  return 0.5 * waist * std::hypot(1.0, (from_laser - focus) / rayleigh);
}

double Speckle::grain() const {
  return wavelength * f_number * (1 + magnification) / pixel_pitch;
}

double Speckle::contrast() const {
  return overlap(0, kWidthPerGrain * grain()) / std::sqrt(averages);
}

double Speckle::correlation(double distance) const {
  const double s = kWidthPerGrain * grain();
  return overlap(std::abs(distance), s) / overlap(0, s);
}

}  // namespace facula
