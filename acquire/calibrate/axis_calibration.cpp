// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/axis_calibration.hpp>
#include <facula/acquire/calibrate/geometric_median.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include <Eigen/Dense>

namespace facula {
namespace {

constexpr double kLeastTurn = 3 * std::numbers::pi / 180;   // of the positions' span [rad]
constexpr double kLeastTravel = 3e-3;                       // the same of a linear axis [m]
constexpr double kLeastPair = 1 * std::numbers::pi / 180;   // between two views that vote [rad]
constexpr double kMostPair = 170 * std::numbers::pi / 180;  // near a half turn the sign is lost
constexpr double kMostGainError = 0.1;                      // beyond, positions are in another unit

/// Two views of one placement: how the board moved in the camera frame between them.
struct Pair {
  std::size_t i;
  std::size_t j;
  double turn;            ///< expected about the axis [rad], or the travel of the head [m]
  RigidTransform motion;  ///< takes board j to board i, camera frame
};

double wrapped(double angle) {
  return std::remainder(angle, 2 * std::numbers::pi);
}

std::vector<Pair> pairs_of(AxisKind kind, const std::vector<AxisView>& views) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (views[i].placement != views[j].placement) continue;
      const double step = views[i].position - views[j].position;
      double turn = step;
      if (kind == AxisKind::kTurntable) turn = wrapped(step);
      if (kind == AxisKind::kPan) turn = wrapped(-step);
      const double size = std::abs(turn);
      if (kind == AxisKind::kLinear ? size < 1e-6 : size < kLeastPair || size > kMostPair) continue;
      pairs.push_back(
          {i, j, turn, views[i].camera_from_board * views[j].camera_from_board.inverse()});
    }
  }
  return pairs;
}

double span_of(const std::vector<AxisView>& views) {
  double span = 0;
  for (const AxisView& a : views) {
    for (const AxisView& b : views) {
      if (a.placement == b.placement) span = std::max(span, a.position - b.position);
    }
  }
  return span;
}

void check_views(AxisKind kind, const std::vector<AxisView>& views, double span) {
  require(kind != AxisKind::kNone,
          "expected an axis of kind pan, turntable or linear to calibrate, got none");
  require(views.size() >= 3,
          "expected at least 3 views of a board at different positions of the axis, got ",
          views.size(),
          "; add pictures");
  for (const AxisView& v : views) {
    require(v.placement < 100000, "view '", v.name, "': expected a placement below 100000");
    require(std::isfinite(v.position) && v.camera_from_board.translation.allFinite() &&
                v.camera_from_board.rotation.coeffs().allFinite(),
            "view '",
            v.name,
            "': expected a finite position and board pose");
  }
  require(span > 0,
          "all views of a board stand at one position of the axis; move the axis between pictures "
          "and leave the board where it is");
  const bool linear = kind == AxisKind::kLinear;
  require(span >= (linear ? kLeastTravel : kLeastTurn),
          "the positions of the views span only ",
          linear ? 1000 * span : span * 180 / std::numbers::pi,
          linear ? " mm where 3 mm are needed; " : " degrees where 3 are needed; ",
          "move the axis further between the pictures");
}

Eigen::Vector3d rotation_vector(const RigidTransform& t) {
  return log_se3(t).tail<3>();
}

Eigen::Matrix3d turned(const Eigen::Vector3d& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// Axis line in the camera frame.
struct Line {
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

Line line_by_votes(const std::vector<Pair>& pairs) {
  std::vector<Eigen::VectorXd> directions;
  std::vector<double> weights;
  for (const Pair& p : pairs) {
    const Eigen::Vector3d v = rotation_vector(p.motion) * (p.turn < 0 ? -1 : 1);
    directions.emplace_back(v.normalized());
    weights.push_back(std::abs(p.turn));
  }
  Line line;
  const Eigen::Vector3d mean = geometric_median(directions, weights);
  require(mean.norm() > 0.5,
          "the boards did not turn about one axis as the positions say; check the order, the unit "
          "and the sign of the positions, and that the boards were not touched");
  line.direction = mean.normalized();
  // (I - R) c = t has one solution square to the axis.
  std::vector<Eigen::VectorXd> centres;
  for (const Pair& p : pairs) {
    const Eigen::Matrix3d m = Eigen::Matrix3d::Identity() - turned(line.direction, p.turn) +
                              line.direction * line.direction.transpose();
    const Eigen::Vector3d& t = p.motion.translation;
    const Eigen::Vector3d across = t - line.direction.dot(t) * line.direction;
    centres.emplace_back(m.inverse() * across);
  }
  line.point = geometric_median(centres, weights);
  return line;
}

Line line_by_least_squares(const std::vector<Pair>& pairs, const Line& start) {
  Line line;
  line.direction.setZero();
  for (const Pair& p : pairs) line.direction += rotation_vector(p.motion) * p.turn;
  if (line.direction.norm() == 0) return start;
  line.direction.normalize();
  Eigen::Matrix3d normal = line.direction * line.direction.transpose();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Pair& p : pairs) {
    const Eigen::Matrix3d m = Eigen::Matrix3d::Identity() - turned(line.direction, p.turn);
    normal += m.transpose() * m;
    right += m.transpose() * p.motion.translation;
  }
  line.point = normal.ldlt().solve(right);
  return line;
}

Axis axis_from_line(AxisKind kind, const Line& line, const std::vector<AxisView>& views) {
  const Eigen::Vector3d& z = line.direction;
  Eigen::Vector3d origin = line.point - z.dot(line.point) * z;  // nearest to the camera centre
  if (kind == AxisKind::kTurntable) {
    for (const AxisView& v : views) {
      const Eigen::Vector3d normal = v.camera_from_board.rotation * Eigen::Vector3d::UnitZ();
      if (std::abs(normal.dot(z)) < std::cos(20 * std::numbers::pi / 180)) continue;
      origin += z * normal.dot(v.camera_from_board.translation - origin) / normal.dot(z);
      break;
    }
  }
  const Eigen::Vector3d ahead =
      kind == AxisKind::kTurntable ? Eigen::Vector3d(-origin) : Eigen::Vector3d::UnitZ();
  Eigen::Vector3d x = ahead - ahead.dot(z) * z;
  if (x.norm() < 1e-3 * ahead.norm()) x = z.unitOrthogonal();
  x.normalize();
  Eigen::Matrix3d rotation;
  rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
  Axis axis;
  axis.kind = kind;
  axis.scan_from_camera = RigidTransform::from_rotation(rotation);
  axis.scan_from_camera.translation = -(rotation * origin);
  return axis;
}

Axis linear_axis(const std::vector<Pair>& pairs, bool by_votes) {
  Axis axis;
  axis.kind = AxisKind::kLinear;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  std::vector<Eigen::VectorXd> votes;
  std::vector<double> weights;
  for (const Pair& p : pairs) {
    // The board's origin moves against the head.
    votes.emplace_back(-p.motion.translation / p.turn);
    weights.push_back(std::abs(p.turn));
    direction -= p.motion.translation * p.turn;
  }
  if (by_votes) direction = geometric_median(votes, weights);
  require(direction.norm() > 0,
          "the boards did not move along one line as the positions say; check the positions");
  axis.direction = direction.normalized();
  return axis;
}

Axis axis_of(AxisKind kind,
             const std::vector<Pair>& pairs,
             const std::vector<AxisView>& views,
             bool by_votes) {
  if (kind == AxisKind::kLinear) return linear_axis(pairs, by_votes);
  Line line = line_by_votes(pairs);
  if (!by_votes) line = line_by_least_squares(pairs, line);
  return axis_from_line(kind, line, views);
}

/// What the board moved over what the positions say, in the middle of all pairs.
double gain_of(const Axis& axis, const std::vector<Pair>& pairs) {
  std::vector<double> gains;
  const Eigen::Vector3d z = axis.scan_from_camera.rotation.conjugate() * Eigen::Vector3d::UnitZ();
  for (const Pair& p : pairs) {
    const double moved = axis.kind == AxisKind::kLinear ? -axis.direction.dot(p.motion.translation)
                                                        : z.dot(rotation_vector(p.motion));
    gains.push_back(moved / p.turn);
  }
  return median(gains);
}

RigidTransform median_pose(const std::vector<RigidTransform>& poses) {
  std::vector<Eigen::VectorXd> translations;
  std::vector<Eigen::VectorXd> rotations;
  for (const RigidTransform& p : poses) {
    translations.emplace_back(p.translation);
    const Eigen::Vector4d q = p.rotation.coeffs();
    rotations.emplace_back(q.dot(poses.front().rotation.coeffs()) < 0 ? Eigen::Vector4d(-q) : q);
  }
  const std::vector<double> weights(poses.size(), 1.0);
  const Eigen::Vector4d q = geometric_median(rotations, weights);
  RigidTransform result;
  result.rotation = Eigen::Quaterniond(q).normalized();
  result.translation = geometric_median(translations, weights);
  return result;
}

void place_boards(const std::vector<AxisView>& views, AxisFit& fit) {
  std::size_t placements = 0;
  for (const AxisView& v : views) placements = std::max(placements, v.placement + 1);
  std::vector<std::vector<RigidTransform>> poses(placements);
  for (const AxisView& v : views) {
    poses[v.placement].push_back(fit.axis.scan_from_camera_at(v.position) * v.camera_from_board);
  }
  fit.scan_from_board.assign(placements, {});
  for (std::size_t p = 0; p < placements; ++p) {
    if (!poses[p].empty()) fit.scan_from_board[p] = median_pose(poses[p]);
  }
}

void judge_views(const std::vector<AxisView>& views, AxisFit& fit) {
  fit.views.assign(views.size(), {});
  std::vector<double> distances;
  std::vector<double> turns;
  double distance2 = 0;
  double turn2 = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const RigidTransform pose =
        fit.axis.scan_from_camera_at(views[i].position) * views[i].camera_from_board;
    const RigidTransform off = fit.scan_from_board[views[i].placement].inverse() * pose;
    fit.views[i] = {off.translation.norm(), rotation_angle(off), true};
    distances.push_back(fit.views[i].distance);
    turns.push_back(fit.views[i].turn);
    distance2 += off.translation.squaredNorm();
    turn2 += turns.back() * turns.back();
  }
  fit.rms_distance = std::sqrt(distance2 / static_cast<double>(views.size()));
  fit.rms_turn = std::sqrt(turn2 / static_cast<double>(views.size()));
  const double most_distance = 5 * median(distances) + 1e-9;
  const double most_turn = 5 * median(turns) + 1e-9;
  for (AxisResidual& r : fit.views) {
    r.inlier = r.distance <= most_distance && r.turn <= most_turn;
  }
}

void warn(AxisFit& fit, const std::vector<AxisView>& views) {
  if (std::abs(fit.gain - 1) > 0.01) {
    std::ostringstream text;
    text.precision(4);
    text << "the boards moved " << fit.gain
         << " times what the positions say: check the steps of the axis or the size of the board";
    fit.warnings.push_back(text.str());
  }
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (fit.views[i].inlier) continue;
    std::ostringstream text;
    text.precision(3);
    text << "view '" << views[i].name << "' disagrees with the others by "
         << 1000 * fit.views[i].distance << " mm and " << fit.views[i].turn * 180 / std::numbers::pi
         << " degrees and was left out of the fit";
    fit.warnings.push_back(text.str());
  }
}

}  // namespace

AxisFit fit_axis(AxisKind kind, const std::vector<AxisView>& views) {
  AxisFit fit;
  fit.span = span_of(views);
  check_views(kind, views, fit.span);
  std::vector<Pair> pairs = pairs_of(kind, views);
  require(!pairs.empty(),
          "no two views of a board stand far enough apart on the axis to tell it; expected steps "
          "between 1 and 170 degrees");
  fit.axis = axis_of(kind, pairs, views, true);
  fit.gain = gain_of(fit.axis, pairs);
  require(std::abs(fit.gain - 1) < kMostGainError,
          "the boards moved ",
          fit.gain,
          " times what the positions say; check the unit of the positions and the size of the "
          "board");
  place_boards(views, fit);
  judge_views(views, fit);
  std::erase_if(pairs,
                [&](const Pair& p) { return !fit.views[p.i].inlier || !fit.views[p.j].inlier; });
  if (!pairs.empty()) {
    fit.axis = axis_of(kind, pairs, views, false);
    place_boards(views, fit);
    judge_views(views, fit);
  }
  warn(fit, views);
  return fit;
}

}  // namespace facula
