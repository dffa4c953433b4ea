// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/axis_calibration.hpp>
#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/acquire/calibrate/joint_start.hpp>
#include <facula/acquire/core/error.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace facula {
namespace {

void check_lines(const CalibrationSet& set, const JointView& view) {
  for (const LaserLineView& line : view.lines) {
    require(line.laser < set.lasers.size(),
            "view '",
            view.points.name,
            "': expected a laser below ",
            set.lasers.size(),
            ", the number named, got ",
            line.laser);
    require(line.pixels.size() == line.sigmas.size(),
            "view '",
            view.points.name,
            "': expected a sigma per pixel of the line, got ",
            line.sigmas.size(),
            " for ",
            line.pixels.size());
    for (std::size_t p = 0; p < line.pixels.size(); ++p) {
      require(line.pixels[p].allFinite() && line.sigmas[p] > 0 && std::isfinite(line.sigmas[p]),
              "view '",
              view.points.name,
              "': expected finite line pixels with sigmas above 0");
    }
  }
}

void check_view(const CalibrationSet& set, const JointView& view) {
  const BoardView& points = view.points;
  require(view.board < set.boards.size(),
          "view '",
          points.name,
          "': expected a board below ",
          set.boards.size(),
          ", the number described, got ",
          view.board);
  require(points.ids.size() == points.pixels.size(),
          "view '",
          points.name,
          "': expected a pixel per board point, got ",
          points.pixels.size(),
          " for ",
          points.ids.size());
  for (std::size_t p = 0; p < points.ids.size(); ++p) {
    require(points.ids[p] >= 0 &&
                static_cast<std::size_t>(points.ids[p]) < set.boards[view.board].size() &&
                points.pixels[p].allFinite(),
            "view '",
            points.name,
            "': expected finite pixels of points below ",
            set.boards[view.board].size(),
            ", the size of the board");
  }
  require(!view.position || set.axis != AxisKind::kNone,
          "view '",
          points.name,
          "' has an axis position, but the set names no kind of axis; name it (pan, turntable, "
          "linear) or drop the positions");
  require(!view.position || std::isfinite(*view.position),
          "view '",
          points.name,
          "': expected a finite axis position");
  check_lines(set, view);
}

void check_set(const CalibrationSet& set) {
  require(!set.boards.empty(), "expected a calibration set with at least one board, got none");
  for (const Board& board : set.boards) board.check();
  for (const JointView& view : set.views) check_view(set, view);
  const std::set<std::string> names(set.lasers.begin(), set.lasers.end());
  require(names.size() == set.lasers.size(), "two lasers of the calibration set have one name");
  require(!set.views.empty(), "expected a calibration set with views, got none");
}

constexpr std::size_t kStartViews = 10;  // enough to start from; the joint fit takes all

/// Evenly chosen entries, at most kStartViews.
template <typename T>
std::vector<T> a_few_of(const std::vector<T>& all) {
  if (all.size() <= kStartViews) return all;
  std::vector<T> few;
  for (std::size_t k = 0; k < kStartViews; ++k) few.push_back(all[k * all.size() / kStartViews]);
  return few;
}

/// Runs `calibrate` on a few of the entries, on all where those do not suffice.
template <typename T, typename Calibrate>
auto from_a_few(const std::vector<T>& all, const Calibrate& calibrate) {
  try {
    return calibrate(a_few_of(all));
  } catch (const Error&) {
    return calibrate(all);
  }
}

/// Intrinsics from the views of the board that is seen most often.
Camera start_camera(const CalibrationSet& set, const JointOptions& options) {
  if (options.camera) {
    options.camera->check();
    return *options.camera;
  }
  require(!options.fix_camera, "expected a camera to hold fixed, got none; name a rig");
  std::vector<std::size_t> seen(set.boards.size(), 0);
  for (const JointView& view : set.views) seen[view.board] += view.points.found() ? 1 : 0;
  const auto most =
      static_cast<std::size_t>(std::max_element(seen.begin(), seen.end()) - seen.begin());
  std::vector<BoardView> views;
  for (const JointView& view : set.views) {
    if (view.board == most && view.points.found()) views.push_back(view.points);
  }
  CameraCalibrationOptions camera_options;
  camera_options.tangential = options.tangential;
  camera_options.radial_terms = options.radial_terms;
  return from_a_few(views, [&](const std::vector<BoardView>& some) {
    return calibrate_camera(set.boards[most], some, camera_options).camera;
  });
}

JointSight sight_of(const CalibrationSet& set, std::size_t v) {
  const JointView& view = set.views[v];
  JointSight sight;
  sight.view = v;
  sight.board = view.board;
  sight.placed = view.position.has_value();
  sight.position = view.position.value_or(0);
  for (std::size_t p = 0; p < view.points.ids.size(); ++p) {
    sight.points.push_back(
        {set.boards[view.board].point(view.points.ids[p]), view.points.pixels[p], false});
  }
  for (const LaserLineView& line : view.lines) {
    const bool per_row = line.direction == StripeDirection::kPerRow;
    const Eigen::Vector2d across = per_row ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
    for (std::size_t p = 0; p < line.pixels.size(); ++p) {
      sight.lines.push_back({line.laser, line.pixels[p], line.sigmas[p], across, false});
    }
  }
  return sight;
}

/// Poses of the boards that can be located; the others are rejected with their reason.
std::vector<RigidTransform> locate_boards(const CalibrationSet& set,
                                          const Camera& camera,
                                          JointStart& start) {
  std::vector<RigidTransform> poses;
  for (std::size_t v = 0; v < set.views.size(); ++v) {
    const JointView& view = set.views[v];
    if (!view.points.found()) {
      start.rejected.push_back("view '" + view.points.name + "': " +
                               (view.points.failure.empty() ? "no points" : view.points.failure));
      continue;
    }
    try {
      poses.push_back(locate_board(set.boards[view.board], view.points, camera).camera_from_board);
      start.sights.push_back(sight_of(set, v));
    } catch (const Error& error) {
      start.rejected.push_back("view '" + view.points.name + "': " + error.what());
    }
  }
  require(!start.sights.empty(),
          "no board could be located in any of ",
          set.views.size(),
          " views; the first says: ",
          start.rejected.front());
  return poses;
}

/// Axis and one pose per placement.
void start_axis(const CalibrationSet& set,
                const std::vector<RigidTransform>& poses,
                JointStart& start) {
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> placements;  // board, placement
  std::vector<AxisView> views;
  for (std::size_t i = 0; i < start.sights.size(); ++i) {
    JointSight& sight = start.sights[i];
    if (!sight.placed) continue;
    const JointView& view = set.views[sight.view];
    const auto key = std::make_pair(view.board, view.placement);
    const std::size_t placement = placements.emplace(key, placements.size()).first->second;
    views.push_back({view.points.name, placement, *view.position, poses[i]});
    sight.pose = placement;
  }
  if (views.empty()) {
    require(set.axis == AxisKind::kNone,
            "the set names a ",
            to_string(set.axis),
            " axis, but no view has a position on it; add positions or leave the axis out");
    return;
  }
  AxisFit fit = fit_axis(set.axis, views);
  start.state.rig.axis = fit.axis;
  start.state.poses = fit.scan_from_board;
  start.warnings = std::move(fit.warnings);
}

void start_lasers(const CalibrationSet& set,
                  const std::vector<RigidTransform>& poses,
                  JointStart& start) {
  std::vector<BoardPose> board_poses;
  board_poses.reserve(poses.size());
  for (const RigidTransform& pose : poses) {
    board_poses.push_back({pose, Eigen::Matrix3d::Zero()});
  }
  for (std::size_t l = 0; l < set.lasers.size(); ++l) {
    std::vector<LaserLineView> lines;
    for (std::size_t i = 0; i < start.sights.size(); ++i) {
      for (LaserLineView line : set.views[start.sights[i].view].lines) {
        if (line.pixels.empty() || line.laser != l) continue;
        line.view = i;
        lines.push_back(std::move(line));
      }
    }
    try {
      LaserPlane plane = from_a_few(lines, [&](const std::vector<LaserLineView>& some) {
        return calibrate_laser(start.state.rig.camera, board_poses, some, l).plane;
      });
      plane.name = set.lasers[l];
      start.state.rig.lasers.push_back(std::move(plane));
    } catch (const Error& error) {
      fail("laser '", set.lasers[l], "': ", error.what());
    }
  }
}

}  // namespace

JointStart start_jointly(const CalibrationSet& set, const JointOptions& options) {
  check_set(set);
  JointStart start;
  JointState& state = start.state;
  state.rig.name = "calibrated";
  state.rig.stripe_direction = set.stripe_direction;
  state.rig.camera = start_camera(set, options);
  const std::vector<RigidTransform> poses = locate_boards(set, state.rig.camera, start);
  start_axis(set, poses, start);
  for (std::size_t i = 0; i < start.sights.size(); ++i) {
    if (start.sights[i].placed) continue;
    start.sights[i].pose = state.poses.size();
    state.poses.push_back(poses[i]);
  }
  start_lasers(set, poses, start);
  state.scales.assign(set.boards.size(), 1.0);
  for (const JointSight& sight : start.sights) state.positions.push_back(sight.position);
  return start;
}

}  // namespace facula
