// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/bench/accuracy/exact_stripe.hpp>

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr double kOnSheet = 1e-6;  // [m]
constexpr double kStep = 4;        // [px] a stripe does not cross a row twice within

/// Distance of a point from the cone, along the plane's normal.
double off_sheet(const LaserPlane& sheet, const Eigen::Vector3d& x) {
  const Eigen::Vector3d ahead = sheet.fan_axis();
  const Eigen::Vector3d aside = sheet.normal.cross(ahead);
  const Eigen::Vector3d rho = x - sheet.fan_origin();
  const double along = rho.dot(ahead);
  return sheet.normal.dot(x) - sheet.distance -
         std::tan(sheet.bow) * (std::hypot(along, rho.dot(aside)) - along);
}

}  // namespace

SurfaceHit plane_surface(const Eigen::Vector3d& normal, double distance) {
  return [=](const Eigen::Vector3d& ray) -> std::optional<Eigen::Vector3d> {
    const double t = distance / normal.dot(ray);
    if (!(t > 0) || !std::isfinite(t)) return std::nullopt;
    return t * ray;
  };
}

Eigen::Vector2d pixel_of(const Rig& rig, double position, int line) {
  if (rig.stripe_direction == StripeDirection::kPerRow) return {position, line};
  return {line, position};
}

std::optional<double> exact_position(const Rig& rig,
                                     std::size_t laser,
                                     const SurfaceHit& surface,
                                     int line) {
  const auto off = [&](double column) {
    const auto ray = rig.camera.undistort(pixel_of(rig, column, line));
    const auto x = ray ? surface({ray->x(), ray->y(), 1}) : std::nullopt;
    return x ? off_sheet(rig.lasers[laser], *x) : std::numeric_limits<double>::quiet_NaN();
  };
  const bool per_row = rig.stripe_direction == StripeDirection::kPerRow;
  const int end = per_row ? rig.camera.width : rig.camera.height;
  double left = -0.5;
  double off_left = off(left);
  for (double right = left + kStep; right < end; right += kStep) {
    const double off_right = off(right);
    if (off_left * off_right <= 0) {  // false for NaN
      double low = left;
      double high = right;
      for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (off(middle) * off_left > 0 ? low : high) = middle;
      }
      // At the edge of a thing the surface jumps over the sheet without meeting it.
      const double found = 0.5 * (low + high);
      if (std::abs(off(found)) < kOnSheet) return found;
    }
    left = right;
    off_left = off_right;
  }
  return std::nullopt;
}

std::vector<double> exact_positions(const Rig& rig, std::size_t laser, const SurfaceHit& surface) {
  std::vector<double> positions;
  const bool per_row = rig.stripe_direction == StripeDirection::kPerRow;
  const int lines = per_row ? rig.camera.height : rig.camera.width;
  for (int line = 0; line < lines; ++line) {
    positions.push_back(exact_position(rig, laser, surface, line)
                            .value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return positions;
}

std::vector<double> noisy(const std::vector<double>& positions, double sigma, Random& random) {
  std::vector<double> moved = positions;
  for (double& position : moved) position += sigma * random.normal();
  return moved;
}

std::vector<double> noisy_mean(const std::vector<double>& positions,
                               double sigma,
                               int count,
                               Random& random) {
  return noisy(positions, sigma / std::sqrt(count), random);
}

}  // namespace facula
