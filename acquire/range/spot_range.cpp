// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/spot_range.hpp>

#include <cmath>
#include <numbers>

namespace facula {

double SpotRange::shift(double px) const {
  return pixel_size * px + offset;
}

double SpotRange::perpendicular(double px) const {
  return focal_length * baseline / shift(px);
}

double SpotRange::along_beam(double px) const {
  return perpendicular(px) / std::sin(laser_angle);
}

double SpotRange::sensitivity(double px) const {
  const double q = perpendicular(px);
  return -q * q / (focal_length * baseline);
}

double SpotRange::perpendicular_off_axis(double px, double row) const {
  const double off_axis = std::atan((row - middle_row) * pixel_size / focal_length);
  const double longer_focal_length = focal_length / std::cos(off_axis);  // (7)
  return longer_focal_length * baseline / shift(px);                     // (6)
}

void SpotRange::check() const {
  for (const double length : {focal_length, baseline, pixel_size}) {
    require(length > 0 && std::isfinite(length),
            "expected focal length, baseline and pixel size above 0 mm, got ",
            1000 * length);
  }
  require(std::isfinite(offset) && std::isfinite(middle_row), "expected a finite offset and row");
  require(laser_angle > 0 && laser_angle < std::numbers::pi,
          "expected the laser at 0 to 180 degrees to the baseline, got ",
          laser_angle * 180 / std::numbers::pi);
}

}  // namespace facula
