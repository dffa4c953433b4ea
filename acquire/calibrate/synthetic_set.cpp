// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/synthetic_set.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>

#include <cmath>
#include <numbers>
#include <optional>

namespace facula {
namespace {

constexpr int kTries = 2000;  // for a board that is seen

double between(Random& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// The world of one set: the rig, one board's geometry, and a stream of random numbers.
struct Scene {
  const Rig& rig;
  const SyntheticSetOptions& options;
  Random random;
};

bool inside(const Camera& c, const Eigen::Vector2d& pixel) {
  return pixel.x() > 2 && pixel.y() > 2 && pixel.x() < c.width - 3 && pixel.y() < c.height - 3;
}

/// Pixel of a point that is in front of the camera and in the image, where the distortion's model
/// also leads back.
std::optional<Eigen::Vector2d> seen_at(const Camera& camera, const Eigen::Vector3d& x) {
  if (!(x.z() > 0)) return std::nullopt;
  const Eigen::Vector2d pixel = camera.project(x);
  if (!inside(camera, pixel) || !camera.undistort(pixel)) return std::nullopt;
  return pixel;
}

Eigen::Vector3d board_centre(const Board& board) {
  return 0.5 * (board.point(0) + board.point(static_cast<int>(board.size()) - 1));
}

/// A board about `centre` whose normal leans against `ahead` by up to `tilt` [rad].
RigidTransform leaning_board(const Board& board,
                             const Eigen::Vector3d& centre,
                             double tilt,
                             Random& random) {
  const double heading = between(random, 0, 2 * std::numbers::pi);
  const double angle = tilt * between(random, 0.5, 1);
  const Eigen::Vector3d axis(std::cos(heading), std::sin(heading), 0);
  RigidTransform pose;
  pose.rotation = Eigen::AngleAxisd(angle, axis) *
                  Eigen::AngleAxisd(between(random, -std::numbers::pi, std::numbers::pi),
                                    Eigen::Vector3d::UnitZ());
  const double reach = 0.25 * board.spacing * board.cols;
  const Eigen::Vector3d off(between(random, -reach, reach), between(random, -reach, reach), 0);
  pose.translation = centre - pose.rotation * (board_centre(board) + off);
  return pose;
}

/// A point of a sheet near a random place of the image, about `distance` from the camera; without
/// lasers a point anywhere.
std::optional<Eigen::Vector3d> random_centre(Scene& scene, double distance, std::size_t view) {
  const Camera& c = scene.rig.camera;
  const double depth = distance * between(scene.random, 0.75, 1.35);
  const double u = between(scene.random, 0.25, 0.75) * c.width;
  const double v = between(scene.random, 0.25, 0.75) * c.height;
  Eigen::Vector3d x((u - c.cx) / c.fx * depth, (v - c.cy) / c.fy * depth, depth);
  if (!scene.rig.lasers.empty()) {
    const LaserPlane& plane = scene.rig.lasers[view % scene.rig.lasers.size()];
    const Eigen::Vector3d across(plane.normal.x(), plane.normal.y(), 0);
    if (across.squaredNorm() < 1e-6) return std::nullopt;
    x += across * (plane.distance - plane.normal.dot(x)) / across.squaredNorm();
    if (!seen_at(c, x)) return std::nullopt;
  }
  return x;
}

/// Where the sheet cuts the board, from edge to edge, with noise; empty when it does not.
LaserLineView line_on_board(Scene& scene, const Board& board, const RigidTransform& pose, int l) {
  LaserLineView line;
  line.laser = static_cast<std::size_t>(l);
  line.direction = scene.rig.stripe_direction;
  const LaserPlane& plane = scene.rig.lasers[line.laser];
  const auto off = [&](double x, double y) {
    return plane.sheet_distance(pose * Eigen::Vector3d(x, y, 0));
  };
  const double width = board.spacing * board.cols;
  const double height = board.spacing * board.rows;
  const Eigen::Vector2d slope(off(1, 0) - off(0, 0), off(0, 1) - off(0, 0));
  const bool along_y = std::abs(slope.x()) > std::abs(slope.y());
  for (int k = 0; k < scene.options.line_points; ++k) {
    const double t =
        (k + 0.5) / scene.options.line_points * (along_y ? height : width) - board.spacing;
    double s = 0;
    for (int step = 0; step < 8; ++step) {
      const double h = 1e-5;
      const auto at = [&](double value) { return along_y ? off(value, t) : off(t, value); };
      s -= at(s) * h / (at(s + h) - at(s));
    }
    const double limit = along_y ? width : height;
    if (!(s > -board.spacing && s < limit)) continue;
    const Eigen::Vector3d x = along_y ? Eigen::Vector3d(s, t, 0) : Eigen::Vector3d(t, s, 0);
    auto pixel = seen_at(scene.rig.camera, pose * x);
    if (!pixel) continue;
    const bool per_row = line.direction == StripeDirection::kPerRow;
    (*pixel)[per_row ? 0 : 1] += scene.options.line_noise * scene.random.normal();
    line.pixels.push_back(*pixel);
    line.sigmas.push_back(std::max(scene.options.line_noise, 1e-3));
  }
  return line;
}

/// The view of a board at a pose; none unless half of the board is seen. `size` is the board's true
/// size over what it is said to be.
std::optional<JointView> view_of(Scene& scene,
                                 const Board& board,
                                 const RigidTransform& pose,
                                 double size) {
  JointView view;
  view.points.image_width = scene.rig.camera.width;
  view.points.image_height = scene.rig.camera.height;
  for (int id = 0; id < static_cast<int>(board.size()); ++id) {
    const auto pixel = seen_at(scene.rig.camera, pose * (size * board.point(id)));
    if (!pixel) continue;
    view.points.ids.push_back(id);
    view.points.pixels.push_back(*pixel);
  }
  if (2 * view.points.ids.size() < board.size()) return std::nullopt;
  for (Eigen::Vector2d& pixel : view.points.pixels) {
    for (int k = 0; k < 2; ++k) pixel[k] += scene.options.point_noise * scene.random.normal();
    if (scene.random.uniform() < scene.options.wrong_share) {
      pixel += Eigen::Vector2d(between(scene.random, -20, 20), between(scene.random, -20, 20));
    }
  }
  for (int l = 0; l < static_cast<int>(scene.rig.lasers.size()); ++l) {
    LaserLineView line = line_on_board(scene, board, pose, l);
    if (line.pixels.size() >= 10) view.lines.push_back(std::move(line));
  }
  return view;
}

void add_hand_views(Scene& scene, CalibrationSet& set) {
  for (int v = 0; v < scene.options.hand_views; ++v) {
    std::optional<JointView> view;
    for (int attempt = 0; attempt < kTries && !view; ++attempt) {
      const auto centre = random_centre(scene, scene.options.distance, static_cast<std::size_t>(v));
      if (!centre) continue;
      const RigidTransform pose = leaning_board(set.boards[0], *centre, 0.9, scene.random);
      view = view_of(scene, set.boards[0], pose, 1);
    }
    require(view.has_value(), "no board of this size is seen by the rig; change --distance");
    view->points.name = "hand " + std::to_string(v + 1);
    set.views.push_back(std::move(*view));
  }
}

/// All positions of one placement; fewer than three views: the board leaves the image too soon.
std::vector<JointView> views_of_placement(Scene& scene,
                                          const Board& board,
                                          const RigidTransform& scan_from_board,
                                          double size) {
  std::vector<JointView> views;
  for (int q = 0; q < scene.options.positions; ++q) {
    const double position =
        scene.options.span * (static_cast<double>(q) / (scene.options.positions - 1) - 0.5);
    const RigidTransform pose =
        scene.rig.axis.scan_from_camera_at(position).inverse() * scan_from_board;
    auto view = view_of(scene, board, pose, size);
    if (!view) continue;
    view->position = position;
    views.push_back(std::move(*view));
  }
  return views;
}

void add_axis_views(Scene& scene, CalibrationSet& set) {
  const std::size_t b = set.boards.size() - 1;
  const double size = b == 0 ? 1 : scene.options.second_scale;
  const double distance =
      scene.options.axis_distance > 0 ? scene.options.axis_distance : scene.options.distance;
  for (int p = 0; p < scene.options.placements; ++p) {
    std::vector<JointView> views;
    for (int attempt = 0; attempt < kTries; ++attempt) {
      const auto centre = random_centre(scene, distance, static_cast<std::size_t>(p));
      if (!centre) continue;
      const RigidTransform pose =
          leaning_board(set.boards[b], *centre, scene.options.axis_tilt, scene.random);
      views =
          views_of_placement(scene, set.boards[b], scene.rig.axis.scan_from_camera * pose, size);
      if (views.size() >= 3) break;
    }
    require(views.size() >= 3,
            "no placement of the board is seen at three positions of the axis; make --span-deg "
            "smaller");
    for (JointView& view : views) {
      view.board = b;
      view.placement = static_cast<std::size_t>(p);
      view.points.name = "placement " + std::to_string(p + 1) + " view " +
                         std::to_string(&view - views.data() + 1);
      set.views.push_back(std::move(view));
    }
  }
}

}  // namespace

void SyntheticSetOptions::check() const {
  require(distance > 0 && distance < 1000,
          "distance: expected above 0 and below 1000 m, got ",
          distance);
  require(axis_distance >= 0 && axis_distance < 1000,
          "axis_distance: expected 0 or more and below 1000 m, got ",
          axis_distance);
  require(board_share > 0 && board_share < 100,
          "board_share: expected above 0 and below 100, got ",
          board_share);
  require(axis_tilt >= 0 && axis_tilt < 1.5,
          "axis_tilt: expected 0 or more and below 1.5 rad, got ",
          axis_tilt);
  require(hand_views >= 0 && placements >= 0 && hand_views <= 1000 && placements <= 1000,
          "hand_views and placements: expected 0 to 1000 each");
  require(positions >= 3 && positions <= 1000, "positions: expected 3 to 1000, got ", positions);
  require(boards == 1 || boards == 2, "boards: expected 1 or 2, got ", boards);
  require(point_noise >= 0 && line_noise >= 0 && wrong_share >= 0 && wrong_share <= 1,
          "point_noise, line_noise and wrong_share: expected 0 or more");
  require(line_points >= 10 && line_points <= 10000,
          "line_points: expected 10 to 10000, got ",
          line_points);
  require(board_cols >= 3 && board_rows >= 3 && board_cols <= 100 && board_rows <= 100,
          "board_cols and board_rows: expected 3 to 100, got ",
          board_cols,
          " and ",
          board_rows);
  require(span > 0 && std::isfinite(span), "span: expected above 0, got ", span);
}

CalibrationSet synthesize_calibration_set(const Rig& rig, const SyntheticSetOptions& options) {
  options.check();
  rig.check();
  CalibrationSet set;
  Board board;
  board.cols = options.board_cols;
  board.rows = options.board_rows;
  board.spacing = options.board_share * options.distance / (options.board_cols - 1);
  set.boards.assign(static_cast<std::size_t>(options.boards), board);
  for (const LaserPlane& laser : rig.lasers) set.lasers.push_back(laser.name);
  set.axis = rig.axis.kind;
  set.stripe_direction = rig.stripe_direction;
  Scene scene{rig, options, Random(options.seed)};
  add_hand_views(scene, set);
  if (rig.axis.kind != AxisKind::kNone) add_axis_views(scene, set);
  return set;
}

}  // namespace facula
