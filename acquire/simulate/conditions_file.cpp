// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/toml_table.hpp>
#include <facula/acquire/simulate/conditions_file.hpp>

#include <numbers>
#include <string>

namespace facula {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Takes key's value, if it is there, times the unit.
void take(TomlTable& table, const std::string& key, double unit, double& target) {
  if (const auto value = table.number_if(key)) target = *value * unit;
}

LaserColour colour_from_name(TomlTable& table, const std::string& key, LaserColour otherwise) {
  const auto name = table.text_if(key);
  if (!name) return otherwise;
  if (*name == "red") return LaserColour::kRed;
  if (*name == "green") return LaserColour::kGreen;
  if (*name == "infrared") return LaserColour::kInfrared;
  fail(table.where(key), ": expected red, green or infrared, got '", *name, "'");
}

void read_laser(TomlTable table, SimulateOptions& o) {
  take(table, "peak_dn", 1, o.laser_peak);
  take(table, "half_width_mm", 1e-3, o.line_half_width);
  take(table, "divergence_mrad", 1e-3, o.line_divergence);
  take(table, "exposure_falloff", 1, o.exposure_falloff);
  o.laser_colour = colour_from_name(table, "colour", o.laser_colour);
  o.all_lasers = table.boolean_if("all_lasers").value_or(o.all_lasers);
  table.finish();
}

void read_beam(TomlTable table, SimulateOptions& o) {
  GaussianBeam beam = o.beam.value_or(GaussianBeam());
  take(table, "waist_um", 1e-6, beam.waist);
  take(table, "focus_mm", 1e-3, beam.focus);
  take(table, "wavelength_nm", 1e-9, beam.wavelength);
  take(table, "quality", 1, beam.quality);
  table.finish();
  o.beam = beam;
}

void read_speckle(TomlTable table, SimulateOptions& o) {
  Speckle speckle = o.speckle.value_or(Speckle());
  take(table, "wavelength_nm", 1e-9, speckle.wavelength);
  take(table, "f_number", 1, speckle.f_number);
  take(table, "magnification", 1, speckle.magnification);
  take(table, "pixel_um", 1e-6, speckle.pixel_pitch);
  take(table, "averages", 1, speckle.averages);
  table.finish();
  o.speckle = speckle;
}

void read_ambient(TomlTable table, SimulateOptions& o) {
  take(table, "level_dn", 1, o.ambient);
  take(table, "flicker_depth", 1, o.flicker.depth);
  take(table, "flicker_hz", 1, o.flicker.frequency);
  take(table, "flicker_phase_deg", kDegree, o.flicker.phase);
  table.finish();
}

void read_lens(TomlTable table, SimulateOptions& o) {
  take(table, "blur_px", 1, o.lens.blur);
  take(table, "glare_share", 1, o.lens.glare_share);
  take(table, "glare_blur_px", 1, o.lens.glare_blur);
  take(table, "vignetting", 1, o.lens.vignetting);
  table.finish();
}

void read_sensor(TomlTable table, SimulateOptions& o) {
  o.colour_frames = table.boolean_if("colour").value_or(o.colour_frames);
  take(table, "read_noise_dn", 1, o.read_noise);
  take(table, "shot_noise_dn", 1, o.shot_noise);
  take(table, "black_level_dn", 1, o.black_level);
  table.finish();
}

void read_timing(TomlTable table, SimulateOptions& o) {
  take(table, "frame_interval_ms", 1e-3, o.timing.frame_interval);
  take(table, "exposure_ms", 1e-3, o.timing.exposure_time);
  take(table, "row_us", 1e-6, o.timing.row_time);
  table.finish();
}

void read_motion(TomlTable table, const Rig& rig, AxisErrors& errors) {
  const bool turns = rig.axis.is_revolute();
  const std::string unit = turns ? "_deg" : "_mm";
  const double factor = turns ? kDegree : 1e-3;
  take(table, "noise" + unit, factor, errors.noise);
  take(table, "periodic" + unit, factor, errors.periodic_amplitude);
  take(table, "period" + unit, factor, errors.period);
  take(table, "phase_deg", kDegree, errors.phase);
  take(table, "backlash" + unit, factor, errors.backlash);
  take(table, "speed" + unit + "_s", factor, errors.speed);
  take(table, "latency_ms", 1e-3, errors.latency);
  table.finish();
}

}  // namespace

SimulateOptions read_conditions(const std::filesystem::path& path,
                                const Rig& rig,
                                SimulateOptions options) {
  TomlTable file = TomlTable::from_file(path);
  if (auto table = file.table_if("laser")) read_laser(std::move(*table), options);
  if (auto table = file.table_if("beam")) read_beam(std::move(*table), options);
  if (auto table = file.table_if("speckle")) read_speckle(std::move(*table), options);
  if (auto table = file.table_if("ambient")) read_ambient(std::move(*table), options);
  if (auto table = file.table_if("lens")) read_lens(std::move(*table), options);
  if (auto table = file.table_if("sensor")) read_sensor(std::move(*table), options);
  if (auto table = file.table_if("timing")) read_timing(std::move(*table), options);
  if (auto table = file.table_if("motion"))
    read_motion(std::move(*table), rig, options.axis_errors);
  file.finish();
  try {
    options.check();
  } catch (const Error& error) {
    fail(path.string(), ": ", error.what());
  }
  return options;
}

}  // namespace facula
