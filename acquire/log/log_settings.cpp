// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_list.hpp>
#include <facula/acquire/capture/stripe_settings.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/toml_text.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/acquire/log/log_settings.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/stripe/stripe_windows.hpp>

#include <locale>
#include <sstream>

namespace facula {
namespace {

/// The file's own bytes give back the very numbers that were read from it; a rig that was changed
/// since, or never had a file, is written anew.
std::string text_of_rig(const Capture& capture) {
  std::string text = rig_text(capture.rig);
  try {
    std::string bytes = read_whole_file(capture.rig_file);
    if (rig_text(parse_rig(bytes, capture.rig_file.stem().string())) == text) return bytes;
  } catch (const Error&) {
    // No such file, or no longer a rig.
  }
  return text;
}

void write_bound(std::ostream& out, const char* key, const std::optional<double>& value) {
  if (value) out << key << " = " << *value << "\n";
}

void write_exposures(std::ostream& out, const std::vector<double>& exposures) {
  if (exposures.empty()) return;
  out << "exposures_ms = [";
  for (std::size_t e = 0; e < exposures.size(); ++e) out << (e == 0 ? "" : ", ") << exposures[e];
  out << "]\n";
}

std::string settings_text(const Capture& capture) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  const Rig& rig = capture.rig;
  out << "rig_name = " << toml_quoted(rig.name)
      << "\nlaser = " << toml_quoted(rig.lasers.empty() ? "" : rig.lasers[capture.laser].name)
      << "\ninterval_s = " << capture.frame_interval << "\n";
  write_exposures(out, capture.exposures);
  if (capture.stand != ScanStand::kFree) {
    out << "stand = " << toml_quoted(to_string(capture.stand)) << "\n";
  }
  out << "\n";
  write_stripe_options(out, capture.stripe);
  const WorkVolume& volume = capture.volume;
  out << "\n[volume]\n";
  write_bound(out, "max_radius_m", volume.max_radius);
  write_bound(out, "min_z_m", volume.min_z);
  write_bound(out, "max_z_m", volume.max_z);
  write_bound(out, "min_depth_m", volume.min_depth);
  write_bound(out, "max_depth_m", volume.max_depth);
  const Eigen::Vector3d& t = capture.world_from_scan.translation;
  const Eigen::Quaterniond& q = capture.world_from_scan.rotation;
  out << "\n[pose]\ntranslation_m = [" << t.x() << ", " << t.y() << ", " << t.z()
      << "]\nquaternion_xyzw = [" << q.x() << ", " << q.y() << ", " << q.z() << ", " << q.w()
      << "]\n";
  if (!capture.zero_line) return out.str();
  out << "\n[zero_line]\nbed_position_px = " << capture.zero_line->bed_position << "\nbed_rows = [";
  const char* separator = "";
  for (const auto& [first, last] : capture.zero_line->bed_rows) {
    out << separator << "[" << first << ", " << last << "]";
    separator = ", ";
  }
  out << "]\n";
  return out.str();
}

WorkVolume read_volume(TomlTable table) {
  WorkVolume volume;
  volume.max_radius = table.number_if("max_radius_m");
  volume.min_z = table.number_if("min_z_m");
  volume.max_z = table.number_if("max_z_m");
  volume.min_depth = table.number_if("min_depth_m");
  volume.max_depth = table.number_if("max_depth_m");
  table.finish();
  volume.check();
  return volume;
}

/// Read without normalising, so that it is the very pose that was written.
RigidTransform read_pose(TomlTable table) {
  RigidTransform pose;
  pose.translation = table.vector3("translation_m");
  const std::vector<double> q = table.numbers("quaternion_xyzw");
  require(q.size() == 4, table.where("quaternion_xyzw"), ": expected four numbers");
  pose.rotation = Eigen::Quaterniond(q[3], q[0], q[1], q[2]);
  table.finish();
  return pose;
}

ZeroLine read_zero_line(TomlTable table) {
  ZeroLine zero_line;
  zero_line.bed_position = table.number("bed_position_px");
  for (const Eigen::Vector2d& rows : table.pairs("bed_rows")) {
    zero_line.bed_rows.emplace_back(static_cast<int>(rows.x()), static_cast<int>(rows.y()));
  }
  table.finish();
  return zero_line;
}

std::size_t laser_index(const Rig& rig, const std::string& name, const std::string& log) {
  for (std::size_t i = 0; i < rig.lasers.size(); ++i) {
    if (rig.lasers[i].name == name) return i;
  }
  require(rig.lasers.empty() && name.empty(), log, ": the rig has no laser '", name, "'");
  return 0;
}

LoggedBackground background_of(const Capture& capture) {
  if (capture.alternation != Alternation::kNone) return LoggedBackground::kPerFrame;
  if (capture.background.empty()) return LoggedBackground::kNone;
  if (capture.flicker != Flicker::kIgnore) return LoggedBackground::kPerFrame;
  const bool common = capture.background.size() == 1 && !is_video(capture.background[0]) &&
                      capture.positions.size() != 1;
  return common ? LoggedBackground::kCommon : LoggedBackground::kPerFrame;
}

}  // namespace

StripeLogHeader header_of(const Capture& capture, int channels) {
  const bool per_row = capture.stripe.direction == StripeDirection::kPerRow;
  const Camera& camera = capture.rig.camera;
  StripeLogHeader header;
  header.rows = per_row ? camera.height : camera.width;
  header.cols = per_row ? camera.width : camera.height;
  header.channels = channels;
  header.width = window_width(header.cols, channels);
  header.exposures = static_cast<int>(capture.exposures_per_position());
  header.bed = capture.zero_line.has_value();
  header.background = background_of(capture);
  header.frames = capture.positions.size();
  header.rig = text_of_rig(capture);
  header.settings = settings_text(capture);
  return header;
}

Capture capture_of(const StripeLogHeader& header, const std::string& name) {
  TomlTable table = TomlTable::from_text(header.settings, name);
  Capture capture;
  capture.file = name;
  capture.rig_file = name;
  capture.rig = parse_rig(header.rig, table.text("rig_name"));
  capture.laser = laser_index(capture.rig, table.text("laser"), name);
  capture.frame_interval = table.number("interval_s");
  if (table.has("exposures_ms")) capture.exposures = table.numbers("exposures_ms");
  const auto stand = stand_from_name(table.text_if("stand").value_or("free"));
  require(stand.has_value(), table.where("stand"), ": expected free, upright or table");
  capture.stand = *stand;
  capture.stripe = read_stripe_options(table.table("stripe"), capture.rig.stripe_direction);
  capture.volume = read_volume(table.table("volume"));
  capture.world_from_scan = read_pose(table.table("pose"));
  if (auto zero_line = table.table_if("zero_line")) {
    capture.zero_line = read_zero_line(std::move(*zero_line));
  }
  table.finish();
  const bool per_row = capture.rig.stripe_direction == StripeDirection::kPerRow;
  const Camera& camera = capture.rig.camera;
  require((per_row ? camera.height : camera.width) == header.rows &&
              (per_row ? camera.width : camera.height) == header.cols &&
              capture.zero_line.has_value() == header.bed &&
              capture.exposures_per_position() == static_cast<std::size_t>(header.exposures),
          "the header of the stripe log '",
          name,
          "' contradicts itself: its rig's camera is of another size than its frames; restore the "
          "file from a copy");
  return capture;
}

void check_same_recording(const StripeLogHeader& found,
                          const StripeLogHeader& wanted,
                          const std::string& name) {
  constexpr const char* kAdvice = "; continue with the same one, or begin a new log";
  require(found.rig == wanted.rig, "the stripe log '", name, "' is one of another rig", kAdvice);
  require(found.rows == wanted.rows && found.cols == wanted.cols &&
              found.channels == wanted.channels && found.width == wanted.width,
          "the stripe log '",
          name,
          "' holds frames of ",
          found.rows,
          " rows of ",
          found.cols,
          " px and ",
          found.channels,
          " channels where this capture has ",
          wanted.rows,
          ", ",
          wanted.cols,
          " and ",
          wanted.channels,
          kAdvice);
  require(found.settings == wanted.settings && found.background == wanted.background,
          "the stripe log '",
          name,
          "' was recorded with other settings than this capture's (line, volume, pose, exposures, "
          "background "
          "or zero line)",
          kAdvice);
  require(found.frames == wanted.frames,
          "the stripe log '",
          name,
          "' is of a recording of ",
          found.frames,
          " frames, and this capture has ",
          wanted.frames,
          kAdvice);
}

}  // namespace facula
