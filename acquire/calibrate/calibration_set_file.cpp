// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/calibration_set_file.hpp>
#include <facula/acquire/calibrate/calibration_views.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/rig/toml_table.hpp>

#include <cmath>
#include <numbers>
#include <optional>

namespace facula {
namespace {

Board read_board(TomlTable& table) {
  Board board;
  board.kind = board_kind_from_name(table.text_if("kind").value_or("chessboard"));
  board.cols = table.integer("cols");
  board.rows = table.integer("rows");
  board.spacing = 1e-3 * table.number("spacing_mm");
  board.marker_size = 1e-3 * table.number_if("marker_mm").value_or(0);
  board.dictionary = table.text_if("dictionary").value_or(board.dictionary);
  table.finish();
  board.check();
  return board;
}

AxisKind read_axis_kind(TomlTable& table) {
  const std::string name = table.text_if("axis").value_or("none");
  for (const AxisKind kind :
       {AxisKind::kNone, AxisKind::kPan, AxisKind::kTurntable, AxisKind::kLinear}) {
    if (to_string(kind) == name) return kind;
  }
  fail(table.where("axis"), ": expected none, pan, turntable or linear, got '", name, "'");
}

StripeDirection read_direction(TomlTable& table) {
  const std::string name = table.text_if("stripe").value_or("upright");
  require(name == "upright" || name == "level",
          table.where("stripe"),
          ": expected upright or level, got '",
          name,
          "'");
  return name == "upright" ? StripeDirection::kPerRow : StripeDirection::kPerColumn;
}

ViewGroup read_group(TomlTable& table) {
  ViewGroup group;
  const auto file = [&](const char* key) -> std::filesystem::path {
    const auto name = table.text_if(key);
    return name ? table.folder() / *name : std::filesystem::path();
  };
  group.where = table.where("corners");
  group.folder = table.folder();
  group.board = static_cast<std::size_t>(std::max(table.integer_if("board").value_or(1), 0)) - 1;
  group.corners = file("corners");
  group.lines = file("lines");
  group.positions = file("positions");
  group.pictures = table.text_if("pictures").value_or("");
  group.lit = table.text_if("lit").value_or("");
  group.laser = table.text_if("laser").value_or("");
  group.channel = channel_from_name(table.text_if("channel").value_or("red-excess"));
  group.line_sigma = table.number_if("sigma_px").value_or(2.0);
  table.finish();
  require(!group.corners.empty() || !group.pictures.empty(),
          group.where,
          ": missing; expected corners as a .csv, or pictures to look for them in");
  return group;
}

double read_position_sigma(TomlTable& table, AxisKind axis) {
  const double degrees = table.number_if("position_sigma_deg").value_or(0);
  const double millimetres = table.number_if("position_sigma_mm").value_or(0);
  require(
      degrees >= 0 && millimetres >= 0, table.where("position_sigma_deg"), ": expected 0 or more");
  return axis == AxisKind::kLinear ? 1e-3 * millimetres : degrees * std::numbers::pi / 180;
}

}  // namespace

CalibrationSetFile read_calibration_set(const std::filesystem::path& path) {
  const bool is_folder = std::filesystem::is_directory(path);
  TomlTable table = TomlTable::from_file(is_folder ? path / "calibration.toml" : path);
  CalibrationSetFile file;
  CalibrationSet& set = file.set;
  set.axis = read_axis_kind(table);
  set.stripe_direction = read_direction(table);
  if (table.has("lasers")) set.lasers = table.texts("lasers");
  file.position_sigma = read_position_sigma(table, set.axis);
  if (const auto rig = table.text_if("camera")) {
    file.camera = read_rig(table.folder() / *rig, RigParts::kCamera).camera;
  }
  const auto width = table.integer_if("image_width_px");
  const auto height = table.integer_if("image_height_px");
  for (TomlTable& board : table.tables("board")) set.boards.push_back(read_board(board));
  require(!set.boards.empty(), table.where("board"), ": expected at least one [[board]]");
  std::vector<ViewGroup> groups;
  for (TomlTable& views : table.tables("views")) groups.push_back(read_group(views));
  require(!groups.empty(), table.where("views"), ": expected at least one [[views]]");
  table.finish();
  read_views(groups, file.camera, set);
  for (JointView& view : set.views) {
    if (view.points.image_width > 0 || view.points.ids.empty()) continue;
    require(width.has_value() && height.has_value(),
            path.string(),
            ": expected image_width_px and image_height_px beside corners from files");
    view.points.image_width = *width;
    view.points.image_height = *height;
  }
  return file;
}

}  // namespace facula
