// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/camera.hpp>

#include <cmath>

#include <Eigen/LU>

namespace facula {
namespace {

void check_number(double value, double limit, const char* name) {
  require(std::isfinite(value) && std::abs(value) <= limit,
          "camera ",
          name,
          ": expected a number of at most ",
          limit,
          ", got ",
          value);
}

}  // namespace

Eigen::Vector2d Camera::distort(const Eigen::Vector2d& normalized) const {
  const double x = normalized.x();
  const double y = normalized.y();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Eigen::Matrix2d Camera::distortion_jacobian(const Eigen::Vector2d& normalized) const {
  const double x = normalized.x();
  const double y = normalized.y();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2 * (k1 + r2 * (2 * k2 + 3 * r2 * k3));  // d radial / d r2, doubled
  Eigen::Matrix2d j;
  j(0, 0) = radial + x * x * slope + 2 * p1 * y + 6 * p2 * x;
  j(0, 1) = x * y * slope + 2 * p1 * x + 2 * p2 * y;
  j(1, 0) = j(0, 1);
  j(1, 1) = radial + y * y * slope + 6 * p1 * y + 2 * p2 * x;
  return j;
}

Eigen::Vector2d Camera::project(const Eigen::Vector3d& x_in_camera) const {
  const Eigen::Vector2d d = distort(x_in_camera.head<2>() / x_in_camera.z());
  return {fx * d.x() + cx, fy * d.y() + cy};
}

std::optional<Eigen::Vector2d> Camera::undistort(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d wanted((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  Eigen::Vector2d n = wanted;
  for (int step = 0; step < 20; ++step) {
    const Eigen::Vector2d error = distort(n) - wanted;
    if (error.squaredNorm() < 1e-26) break;
    const Eigen::Matrix2d jacobian = distortion_jacobian(n);
    if (!(jacobian.determinant() > 1e-3)) return std::nullopt;
    n -= jacobian.inverse() * error;
  }
  // Newton's method may land behind the fold, where the image of n is right but n is not.
  if (!n.allFinite() || (distort(n) - wanted).norm() > 1e-9 ||
      !(distortion_jacobian(n).determinant() > 1e-3)) {
    return std::nullopt;
  }
  return n;
}

void Camera::check() const {
  require(width > 0 && height > 0 && width <= 100000 && height <= 100000,
          "camera width_px and height_px: expected 1 to 100000, got ",
          width,
          " x ",
          height);
  require(std::isfinite(fx) && std::isfinite(fy) && fx > 0 && fy > 0 && fx < 1e6 && fy < 1e6,
          "camera fx_px and fy_px: expected focal lengths above 0 and below 1e6, got ",
          fx,
          " and ",
          fy);
  check_number(cx, 10.0 * width, "cx_px");
  check_number(cy, 10.0 * height, "cy_px");
  for (const double k : {k1, k2, k3, p1, p2}) check_number(k, 100, "distortion coefficient");
  for (const double u : {0.0, 0.5 * (width - 1), width - 1.0}) {
    for (const double v : {0.0, 0.5 * (height - 1), height - 1.0}) {
      require(undistort({u, v}).has_value(),
              "camera distortion folds the image over itself at pixel (",
              u,
              ", ",
              v,
              "); check k1 k2 k3 p1 p2 and the focal length");
    }
  }
}

}  // namespace facula
