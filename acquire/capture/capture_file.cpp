// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/axis_positions.hpp>
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/capture/frame_list.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/capture/stripe_settings.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/rig/toml_table.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace facula {
namespace {

using OptionalPath = std::optional<std::filesystem::path>;

std::filesystem::path frames_base(TomlTable& table, const OptionalPath& frames_folder) {
  const std::filesystem::path in_file = table.folder() / table.text_if("folder").value_or("");
  return frames_folder.value_or(in_file);
}

constexpr std::array<std::pair<const char*, Alternation>, 5> kAlternations = {{
    {"no", Alternation::kNone},
    {"on-first", Alternation::kOnFirst},
    {"off-first", Alternation::kOffFirst},
    {"on-off-on", Alternation::kOnOffOn},
    {"off-on-off", Alternation::kOffOnOff},
}};

Alternation read_alternation(TomlTable& table) {
  const std::string name = table.text_if("alternating").value_or("no");
  for (const auto& [known, alternation] : kAlternations) {
    if (name == known) return alternation;
  }
  fail(table.where("alternating"),
       ": expected no, on-first, off-first, on-off-on or off-on-off, got '",
       name,
       "'");
}

Flicker read_flicker(TomlTable& table, const Capture& capture) {
  const auto name = table.text_if("flicker");
  if (!name) return Flicker::kIgnore;
  require(capture.alternation != Alternation::kNone || !capture.background.empty(),
          table.where("flicker"),
          ": there is no background to match; name one with 'off' or 'alternating'");
  return flicker_from_name(*name);
}

std::vector<double> read_exposures(TomlTable& table) {
  if (!table.has("exposures_ms")) return {};
  std::vector<double> exposures = table.numbers("exposures_ms");
  require(!exposures.empty() && exposures.size() <= 16,
          table.where("exposures_ms"),
          ": expected 1 to 16 exposures, got ",
          exposures.size());
  for (const double exposure : exposures) {
    require(exposure > 0, table.where("exposures_ms"), ": expected times above 0, got ", exposure);
  }
  return exposures;
}

void read_frames(TomlTable table, const OptionalPath& frames_folder, Capture& capture) {
  const std::filesystem::path base = frames_base(table, frames_folder);
  capture.frames = list_frames(base, table.text("on"));
  if (const auto off = table.text_if("off")) capture.background = list_frames(base, *off);
  capture.alternation = read_alternation(table);
  require(capture.alternation == Alternation::kNone || capture.background.empty(),
          table.where("off"),
          ": alternating frames bring their own background; drop one of the two");
  capture.flicker = read_flicker(table, capture);
  capture.exposures = read_exposures(table);
  capture.frame_interval = table.number_if("interval_s").value_or(0);
  require(capture.frame_interval >= 0,
          table.where("interval_s"),
          ": expected a time of 0 or more, got ",
          capture.frame_interval);
  if (const auto zero = table.text_if("zero_line")) {
    capture.zero_line = ZeroLine{};
    capture.zero_line->frames = list_frames(base, *zero);
  }
  table.finish();
}

std::vector<double> stepped_positions(TomlTable& table, AxisKind axis, std::size_t count) {
  const bool linear = axis == AxisKind::kLinear;
  const double unit = linear ? 1e-3 : std::numbers::pi / 180;
  const double start = table.number_if(linear ? "start_mm" : "start_deg").value_or(0) * unit;
  const double step = table.number(linear ? "step_mm" : "step_deg") * unit;
  std::vector<double> positions(count);
  for (std::size_t i = 0; i < count; ++i) positions[i] = start + static_cast<double>(i) * step;
  return positions;
}

void read_positions(std::optional<TomlTable> table, std::size_t count, Capture& capture) {
  const AxisKind axis = capture.rig.axis.kind;
  if (!table) {
    require(axis == AxisKind::kNone,
            capture.file.string(),
            ": a rig with a ",
            to_string(axis),
            " axis needs a table [positions]");
    capture.positions.assign(count, 0);
    return;
  }
  if (const auto csv = table->text_if("csv")) {
    capture.positions = read_axis_positions(table->folder() / *csv, axis);
  } else {
    capture.positions = stepped_positions(*table, axis, count);
  }
  table->finish();
}

std::optional<double> length_if(TomlTable& table, const std::string& key) {
  const std::optional<double> value = table.number_if(key);
  return value ? std::optional<double>(*value * 1e-3) : std::nullopt;
}

WorkVolume read_volume(TomlTable table) {
  WorkVolume volume;
  volume.max_radius = length_if(table, "max_radius_mm");
  volume.min_z = length_if(table, "min_z_mm");
  volume.max_z = length_if(table, "max_z_mm");
  volume.min_depth = length_if(table, "min_depth_mm");
  volume.max_depth = length_if(table, "max_depth_mm");
  table.finish();
  volume.check();
  return volume;
}

void read_zero_line(TomlTable table, Capture& capture) {
  require(capture.zero_line.has_value(),
          table.where("bed_rows"),
          ": [zero_line] needs its frames named in [frames], key zero_line");
  const std::string where = table.where("bed_rows");
  for (const Eigen::Vector2d& rows : table.pairs("bed_rows")) {
    capture.zero_line->bed_rows.emplace_back(whole_pixels(rows.x(), where),
                                             whole_pixels(rows.y(), where));
  }
  capture.zero_line->bed_position = table.number("bed_position_px");
  table.finish();
}

/// Axis positions that the frames were taken at.
std::size_t position_count(const Capture& capture) {
  const std::size_t frames =
      capture.frames.size() == 1 ? open_frames(capture.frames)->size() : capture.frames.size();
  const std::size_t each =
      frames_per_exposure(capture.alternation) * capture.exposures_per_position();
  require(capture.exposures.empty() || frames % each == 0,
          capture.file.string(),
          ": expected ",
          each,
          " frames per position, for every exposure in exposures_ms, got ",
          frames,
          " frames, which is no multiple of that");
  require(frames >= each,
          capture.file.string(),
          ": expected ",
          each,
          " frames per position as 'alternating' says, got ",
          frames,
          " in all; check the pattern in [frames]");
  return frames / each;
}

void check_counts(const Capture& capture, std::size_t lit) {
  require(capture.positions.size() == lit,
          capture.file.string(),
          ": expected as many axis positions as frames, got ",
          capture.positions.size(),
          " positions for ",
          lit,
          " frames; check [positions] and the pattern in [frames]");
  const std::size_t exposures = capture.exposures_per_position();
  const std::size_t backgrounds = capture.background.size();
  require(backgrounds <= 1 || backgrounds == exposures || backgrounds == lit * exposures,
          capture.file.string(),
          ": expected one background for all frames or one each, got ",
          backgrounds,
          " for ",
          lit * exposures,
          " frames");
  require(!capture.zero_line || exposures == 1,
          capture.file.string(),
          ": a zero_line has no exposures of its own; drop exposures_ms or the zero_line");
  require(!capture.zero_line || capture.zero_line->frames.size() == lit,
          capture.file.string(),
          ": expected one zero_line frame per position, got ",
          capture.zero_line ? capture.zero_line->frames.size() : 0,
          " for ",
          lit);
}

ScanStand read_stand(TomlTable& table) {
  const auto name = table.text_if("stand");
  const auto stand = stand_from_name(name.value_or("free"));
  require(stand.has_value(),
          table.where("stand"),
          ": expected free, upright or table, got '",
          name.value_or(""),
          "'");
  return *stand;
}

/// The laser the capture names; it may stay silent where the rig has only one.
std::size_t read_laser(TomlTable& table, const Rig& rig) {
  const std::optional<std::string> name = table.text_if("laser");
  require(name.has_value() || rig.light_count() == 1,
          table.where("laser"),
          ": missing; the rig has ",
          rig.light_count(),
          " lasers, so the capture must name the one that is lit");
  if (!name) return 0;
  for (std::size_t i = 0; i < rig.lasers.size(); ++i) {
    if (rig.lasers[i].name == *name) return i;
  }
  fail(table.where("laser"), ": the rig has no laser '", *name, "'");
}

}  // namespace

Capture read_capture(const std::filesystem::path& path, const OptionalPath& frames_folder) {
  Capture capture;
  capture.file = std::filesystem::is_directory(path) ? path / "capture.toml" : path;
  TomlTable table = TomlTable::from_file(capture.file);
  capture.rig_file = table.folder() / table.text("rig");
  capture.rig = read_rig(capture.rig_file);
  capture.laser = read_laser(table, capture.rig);
  capture.stand = read_stand(table);
  std::optional<TomlTable> positions = table.table_if("positions");
  std::optional<TomlTable> stripe = table.table_if("stripe");
  std::optional<TomlTable> volume = table.table_if("volume");
  std::optional<TomlTable> zero_line = table.table_if("zero_line");
  std::optional<TomlTable> pose = table.table_if("pose");
  TomlTable frames = table.table("frames");
  table.finish();

  capture.stripe.direction = capture.rig.stripe_direction;
  if (stripe)
    capture.stripe = read_stripe_options(std::move(*stripe), capture.rig.stripe_direction);
  if (volume) capture.volume = read_volume(std::move(*volume));
  if (pose) {
    capture.world_from_scan = pose->pose();
    pose->finish();
  }
  read_frames(std::move(frames), frames_folder, capture);
  require(zero_line.has_value() || !capture.zero_line,
          capture.file.string(),
          ": zero_line frames need a table [zero_line] with bed_rows and bed_position_px");
  if (zero_line) read_zero_line(std::move(*zero_line), capture);
  const std::size_t lit = position_count(capture);
  read_positions(std::move(positions), lit, capture);
  check_counts(capture, lit);
  return capture;
}

Capture with_rig(Capture capture, const std::filesystem::path& rig_file) {
  const Rig old = std::move(capture.rig);
  capture.rig = read_rig(rig_file);
  capture.rig_file = rig_file;
  const Rig& rig = capture.rig;
  require(rig.camera.width == old.camera.width && rig.camera.height == old.camera.height,
          rig_file.string(),
          ": expected a rig whose camera has ",
          old.camera.width,
          " x ",
          old.camera.height,
          " px as the frames have, got ",
          rig.camera.width,
          " x ",
          rig.camera.height,
          "; name the rig that recorded them");
  require(rig.stripe_direction == old.stripe_direction,
          rig_file.string(),
          ": expected a rig whose stripe runs the way it does in the frames; name the rig that "
          "recorded them");
  const std::string name = old.lasers.empty() ? "" : old.lasers[capture.laser].name;
  for (capture.laser = 0; capture.laser < rig.lasers.size(); ++capture.laser) {
    if (rig.lasers[capture.laser].name == name) return capture;
  }
  require(rig.light_count() == 1,
          rig_file.string(),
          ": the frames were lit by laser '",
          name,
          "', which this rig does not have; give one of its lasers that name");
  capture.laser = 0;
  return capture;
}

}  // namespace facula
