// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/triangulate/triangulate.hpp>
#include <facula/tests/bench/accuracy/exact_stripe.hpp>
#include <facula/tests/bench/accuracy/source_b_boxes.hpp>
#include <facula/tests/bench/accuracy/table_file.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr double kNoise = 0.1;       // [px]
constexpr double kTolerance = 0.01;  // of the distance
constexpr double kTurn = 0.5;        // of the box about the upright [rad]

const Eigen::Vector3d kSize(0.4, 0.5, 0.6);  // [m]

/// First meeting of a ray with a box, by slabs, in the camera frame.
SurfaceHit box_surface(const RigidTransform& camera_from_box) {
  const RigidTransform box_from_camera = camera_from_box.inverse();
  return [=](const Eigen::Vector3d& ray) -> std::optional<Eigen::Vector3d> {
    const Eigen::Vector3d o = box_from_camera.translation;
    const Eigen::Vector3d d = box_from_camera.rotation * ray;
    double enter = 0;
    double leave = 1e9;
    for (int k = 0; k < 3; ++k) {
      const double a = (-0.5 * kSize[k] - o[k]) / d[k];
      const double b = (0.5 * kSize[k] - o[k]) / d[k];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (!(enter > 0) || enter > leave) return std::nullopt;
    return enter * ray;
  };
}

struct Counts {
  std::size_t points = 0;
  std::size_t right_compensated = 0;
  std::size_t right_joint = 0;
};

bool close(double depth, double truth) {
  return std::abs(depth - truth) <= kTolerance * truth;
}

void count_frame(const Rig& truth,
                 const SourceBRigs& rigs,
                 const SurfaceHit& surface,
                 Random& random,
                 Counts& counts) {
  for (int row = 0; row < truth.camera.height; ++row) {
    const auto column = exact_position(truth, 0, surface, row);
    if (!column) continue;
    const auto ray = truth.camera.undistort({*column, static_cast<double>(row)});
    const double depth = surface({ray->x(), ray->y(), 1})->z();
    const double seen = *column + kNoise * random.normal();
    ++counts.points;
    const auto compensated = rigs.curve.depth(rigs.table.corrected(row, seen));
    if (compensated && close(*compensated, depth)) ++counts.right_compensated;
    const auto x = triangulate(rigs.joint, 0, {seen, static_cast<double>(row)}, kNoise);
    if (x && close(x->x_in_camera.z(), depth)) ++counts.right_joint;
  }
}

Counts scan_box(const Rig& truth, const SourceBRigs& rigs, double distance, Random& random) {
  RigidTransform scan_from_box;
  scan_from_box.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(kTurn, Eigen::Vector3d::UnitZ()));
  scan_from_box.translation = {distance + 0.5 * kSize.x(), 0, 0};
  Counts counts;
  for (int degrees = -40; degrees <= 40; ++degrees) {
    const double position = degrees * std::numbers::pi / 180;
    const RigidTransform camera_from_scan = truth.axis.scan_from_camera_at(position).inverse();
    count_frame(truth, rigs, box_surface(camera_from_scan * scan_from_box), random, counts);
  }
  return counts;
}

double percent(std::size_t part, std::size_t whole) {
  return whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0;
}

}  // namespace

BoxRates scan_boxes(const Rig& truth,
                    const SourceBHead& head,
                    const SourceBRigs& rigs,
                    const std::filesystem::path& published,
                    Random& random) {
  BoxRates rates;
  rates.table.caption = head.name + ", boxes: share of points within 1 % of the distance.";
  rates.table.columns = {"distance [m]", "paper [%]", "compensation [%]", "joint [%]", "points"};
  for (const auto& row : read_table(published)) {
    if (row.at("fs_mm2") != head.fs) continue;
    const double distance = row.at("distance_m");
    const Counts counts = scan_box(truth, rigs, distance, random);
    const double compensated = percent(counts.right_compensated, counts.points);
    const double joint = percent(counts.right_joint, counts.points);
    rates.worst_rate = std::min({rates.worst_rate, compensated, joint});
    rates.table.rows.push_back({decimals(distance, 0),
                                decimals(row.at("correct_rate_percent"), 1),
                                decimals(compensated, 1),
                                decimals(joint, 1),
                                std::to_string(counts.points)});
  }
  return rates;
}

}  // namespace facula
