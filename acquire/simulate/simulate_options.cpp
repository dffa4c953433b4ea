// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/simulate/laser_fan.hpp>

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

void check_beam(const GaussianBeam& beam) {
  check_range("beam.waist", beam.waist, 1e-6, 1);
  check_range("beam.focus", beam.focus, -1e3, 1e3);
  check_range("beam.wavelength", beam.wavelength, 1e-8, 1e-4);
  check_range("beam.quality", beam.quality, 1, 1e4);
}

void check_speckle(const Speckle& speckle) {
  check_range("speckle.wavelength", speckle.wavelength, 1e-8, 1e-4);
  check_range("speckle.f_number", speckle.f_number, 0.1, 1e3);
  check_range("speckle.magnification", speckle.magnification, 0, 100);
  check_range("speckle.pixel_pitch", speckle.pixel_pitch, 1e-7, 1e-3);
  check_range("speckle.averages", speckle.averages, 1, 1e4);
  check_range("speckle's grain [px]", speckle.grain(), 0, 50);
}

void check_lens(const Lens& lens) {
  check_range("lens.blur", lens.blur, 0, 20);
  check_range("lens.glare_share", lens.glare_share, 0, 1);
  check_range("lens.glare_blur", lens.glare_blur, 0, 200);
  check_range("lens.vignetting", lens.vignetting, 0, 40);
}

void check_timing(const Timing& timing, const MainsFlicker& flicker) {
  check_range("timing.frame_interval", timing.frame_interval, 0, 3600);
  check_range("timing.exposure_time", timing.exposure_time, 0, 3600);
  check_range("timing.row_time", timing.row_time, 0, 1);
  check_range("flicker.depth", flicker.depth, 0, 1);
  check_range("flicker.frequency", flicker.frequency, 0, 1e6);
  check_range("flicker.phase", flicker.phase, -1e3, 1e3);
}

void check_axis_errors(const AxisErrors& errors) {
  check_range("axis_errors.noise", errors.noise, 0, 1);
  check_range("axis_errors.periodic_amplitude", errors.periodic_amplitude, -1, 1);
  check_range("axis_errors.period", errors.period, 1e-9, 1e6);
  check_range("axis_errors.phase", errors.phase, -1e3, 1e3);
  check_range("axis_errors.backlash", errors.backlash, 0, 1);
  check_range("axis_errors.speed", errors.speed, -1e3, 1e3);
  check_range("axis_errors.latency", errors.latency, 0, 60);
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
  check_range("stripe_noise", stripe_noise, 0, 100);
  if (beam) check_beam(*beam);
  if (speckle) check_speckle(*speckle);
  check_lens(lens);
  check_timing(timing, flicker);
  check_axis_errors(axis_errors);
}

SimulateOptions options_for(const Rig& rig) {
  rig.check();
  require(!rig.lasers.empty(), "rig '", rig.name, "' has no [[laser]]: nothing can be simulated");
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
