// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/calibration_views.hpp>
#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/acquire/capture/frame_list.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/csv_table.hpp>
#include <facula/acquire/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace facula {
namespace {

/// Rows of a table by the view they belong to, in the order in which views appear.
struct RowsByView {
  std::vector<std::string> names;
  std::map<std::string, std::vector<std::size_t>> rows;
};

RowsByView rows_by_view(const CsvTable& table) {
  RowsByView result;
  const std::vector<std::string> names = table.texts("view");
  for (std::size_t r = 0; r < names.size(); ++r) {
    auto& rows = result.rows[names[r]];
    if (rows.empty()) result.names.push_back(names[r]);
    rows.push_back(r);
  }
  return result;
}

/// Point ids, written as such or as places on the board.
std::vector<int> point_ids(const CsvTable& table, const Board& board, const std::string& where) {
  std::vector<int> ids;
  if (table.has("point")) {
    for (const double id : table.column({"point"})) {
      require(id >= 0 && id < static_cast<double>(board.size()) && id == std::floor(id),
              where,
              ": expected points from 0 to ",
              board.size() - 1,
              ", got ",
              id);
      ids.push_back(static_cast<int>(id));
    }
    return ids;
  }
  const std::vector<double> x = table.column({"board_x_mm"});
  const std::vector<double> y = table.column({"board_y_mm"});
  for (std::size_t r = 0; r < x.size(); ++r) {
    int nearest = 0;
    double distance = 1e300;
    for (int id = 0; id < static_cast<int>(board.size()); ++id) {
      const double d = (board.point(id).head<2>() - Eigen::Vector2d(x[r], y[r])).norm();
      if (d < distance) nearest = id;
      distance = std::min(d, distance);
    }
    require(distance < 0.01 * board.spacing,
            where,
            ": expected places of the board's points, got one ",
            1000 * distance,
            " mm off");
    ids.push_back(nearest);
  }
  return ids;
}

std::vector<JointView> views_from_corners(const ViewGroup& group, const Board& board) {
  const CsvTable table = CsvTable::from_file(group.corners);
  const std::vector<double> x = table.column({"x_px"});
  const std::vector<double> y = table.column({"y_px"});
  const std::vector<int> ids = point_ids(table, board, group.corners.string());
  const RowsByView by_view = rows_by_view(table);
  std::vector<JointView> views;
  for (const std::string& name : by_view.names) {
    JointView view;
    view.points.name = name;
    std::vector<std::size_t> rows = by_view.rows.at(name);
    std::sort(rows.begin(), rows.end(), [&](auto a, auto b) { return ids[a] < ids[b]; });
    for (const std::size_t r : rows) {
      require(view.points.ids.empty() || view.points.ids.back() != ids[r],
              group.corners.string(),
              ": view '",
              name,
              "' shows point ",
              ids[r],
              " twice");
      view.points.ids.push_back(ids[r]);
      view.points.pixels.emplace_back(x[r], y[r]);
    }
    views.push_back(std::move(view));
  }
  return views;
}

std::vector<JointView> views_from_pictures(const ViewGroup& group, const Board& board) {
  std::vector<JointView> views;
  for (const auto& file : list_frames(group.folder, group.pictures)) {
    JointView view;
    view.points = find_board(read_image(file).view(), board, file.filename().string());
    views.push_back(std::move(view));
  }
  return views;
}

void add_positions(const ViewGroup& group, AxisKind axis, std::vector<JointView>& views) {
  const CsvTable table = CsvTable::from_file(group.positions);
  const std::vector<double> positions = axis == AxisKind::kLinear
                                            ? table.column({"position_mm"})
                                            : table.column({"position_deg", "position_rad"});
  require(positions.size() == views.size(),
          group.positions.string(),
          ": expected a row per view, ",
          views.size(),
          ", got ",
          positions.size());
  const std::vector<double> placements = table.has("placement")
                                             ? table.column({"placement"})
                                             : std::vector<double>(positions.size(), 1);
  for (std::size_t v = 0; v < views.size(); ++v) {
    views[v].position = positions[v];
    require(placements[v] >= 1 && placements[v] <= 10000,
            group.positions.string(),
            ": expected placements from 1 to 10000, got ",
            placements[v]);
    views[v].placement = static_cast<std::size_t>(placements[v]) - 1;
  }
}

std::size_t laser_index(const CalibrationSet& set, const std::string& name, const std::string& at) {
  const auto it = std::find(set.lasers.begin(), set.lasers.end(), name);
  require(it != set.lasers.end(), at, ": there is no laser '", name, "' in `lasers`");
  return static_cast<std::size_t>(it - set.lasers.begin());
}

void add_lines(const ViewGroup& group, const CalibrationSet& set, std::vector<JointView>& views) {
  const CsvTable table = CsvTable::from_file(group.lines);
  const std::vector<std::string> lasers = table.texts("laser");
  const std::vector<double> x = table.column({"x_px"});
  const std::vector<double> y = table.column({"y_px"});
  const std::vector<double> sigma = table.column({"sigma_px"});
  const RowsByView by_view = rows_by_view(table);
  for (const std::string& name : by_view.names) {
    const auto view = std::find_if(
        views.begin(), views.end(), [&](const JointView& v) { return v.points.name == name; });
    require(view != views.end(),
            group.lines.string(),
            ": there is no view '",
            name,
            "' among the corners");
    std::map<std::size_t, LaserLineView> lines;
    for (const std::size_t r : by_view.rows.at(name)) {
      LaserLineView& line = lines[laser_index(set, lasers[r], group.lines.string())];
      line.pixels.emplace_back(x[r], y[r]);
      line.sigmas.push_back(sigma[r]);
    }
    for (auto& [laser, line] : lines) {
      line.laser = laser;
      line.direction = set.stripe_direction;
      view->lines.push_back(std::move(line));
    }
  }
}

/// Camera from the corners of the group's own views.
Camera camera_from(const std::vector<JointView>& views, const Board& board) {
  std::vector<BoardView> found;
  for (const JointView& view : views) {
    if (view.points.found()) found.push_back(view.points);
  }
  return calibrate_camera(board, found).camera;
}

void find_lines(const ViewGroup& group,
                const Camera& camera,
                const CalibrationSet& set,
                std::vector<JointView>& views) {
  const std::size_t laser = laser_index(set, group.laser, group.where);
  const auto lit = list_frames(group.folder, group.lit.empty() ? group.pictures : group.lit);
  require(lit.size() == views.size(),
          group.where,
          ": expected a lit picture per view, ",
          views.size(),
          ", got ",
          lit.size());
  std::vector<std::filesystem::path> dark;
  if (!group.lit.empty() && !group.pictures.empty()) {
    dark = list_frames(group.folder, group.pictures);
  }
  BoardLineOptions options;
  options.stripe.channel = group.channel;
  options.stripe.sigma = group.line_sigma;
  options.stripe.direction = set.stripe_direction;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (!views[v].points.found()) continue;
    const Board& board = set.boards[group.board];
    const RigidTransform pose = locate_board(board, views[v].points, camera).camera_from_board;
    const Image8 background = v < dark.size() ? read_image(dark[v]) : Image8{};
    LaserLineView line = find_line_on_board(
        read_image(lit[v]).view(), background.view(), board, camera, pose, options);
    line.laser = laser;
    if (line.failure.empty()) views[v].lines.push_back(std::move(line));
  }
}

}  // namespace

void read_views(const std::vector<ViewGroup>& groups,
                const std::optional<Camera>& camera,
                CalibrationSet& set) {
  for (const ViewGroup& group : groups) {
    require(group.board < set.boards.size(),
            group.where,
            ": expected a board from 1 to ",
            set.boards.size());
    const Board& board = set.boards[group.board];
    std::vector<JointView> views = group.corners.empty() ? views_from_pictures(group, board)
                                                         : views_from_corners(group, board);
    for (JointView& view : views) view.board = group.board;
    if (!group.positions.empty()) add_positions(group, set.axis, views);
    if (!group.lines.empty()) add_lines(group, set, views);
    if (!group.laser.empty() && group.lines.empty()) {
      find_lines(group, camera ? *camera : camera_from(views, board), set, views);
    }
    for (JointView& view : views) set.views.push_back(std::move(view));
  }
  if (!camera) return;
  for (JointView& view : set.views) {
    view.points.image_width = camera->width;
    view.points.image_height = camera->height;
  }
}

}  // namespace facula
