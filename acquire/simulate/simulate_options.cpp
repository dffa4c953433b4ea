// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/simulate/simulate.hpp>

#include <cmath>

namespace facula {
namespace {

void check_range(const char* field, double value, double low, double high) {
  require(std::isfinite(value) && value >= low && value <= high,
          "SimulateOptions::",
          field,
          " must lie in [",
          low,
          ", ",
          high,
          "], but is ",
          value);
}

double working_distance(const LaserPlane& sheet) {
  const double crossing = sheet.distance / sheet.normal.z();
  const bool crosses = std::isfinite(crossing) && crossing > 0 && crossing < 100;
  return crosses ? crossing : 4 * std::abs(sheet.distance);
}

// The sheet's point nearest to the camera centre within the plane z = 0.
Eigen::Vector3d beside_camera(const LaserPlane& sheet) {
  const Eigen::Vector2d across = sheet.normal.head<2>();
  if (across.squaredNorm() < 1e-4) return sheet.distance * sheet.normal;  // square to the axis
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  origin.head<2>() = sheet.distance / across.squaredNorm() * across;
  return origin;
}

}  // namespace

void SimulateOptions::check() const {
  require(laser_origin.allFinite(), "SimulateOptions::laser_origin must be finite");
  check_range("line_half_width", line_half_width, 0, 1);
  check_range("line_divergence", line_divergence, 0, 1);
  require(line_half_width + line_divergence > 1e-9,
          "SimulateOptions::line_half_width and line_divergence must not both be 0");
  check_range("laser_peak", laser_peak, 0, 1e6);
  check_range("exposure_falloff", exposure_falloff, -4, 4);
  check_range("ambient", ambient, 0, 1e6);
  check_range("read_noise", read_noise, 0, 255);
  check_range("shot_noise", shot_noise, 0, 255);
  check_range("black_level", black_level, -255, 255);
  check_range("axis_noise", axis_noise, 0, 1);
}

SimulateOptions options_for(const Rig& rig) {
  rig.check();
  const LaserPlane& sheet = rig.lasers.front();
  const double focal_length = 0.5 * (rig.camera.fx + rig.camera.fy);
  const double distance = working_distance(sheet);
  SimulateOptions options;
  options.laser_origin = beside_camera(sheet);
  options.line_divergence = 1.5 / focal_length;
  options.line_half_width = 0.5 / focal_length * distance;
  options.exposure_falloff = rig.axis.kind == AxisKind::kTurntable ? 1 : 0;
  const Eigen::Vector3d target(0, 0, distance);
  const double r = (target - options.laser_origin).norm();
  const double width_at_1_m = options.line_half_width + options.line_divergence;
  const double width_at_target = options.line_half_width + options.line_divergence * r;
  options.laser_peak = 170 * std::pow(r, options.exposure_falloff) * width_at_target / width_at_1_m;
  return options;
}

}  // namespace facula
