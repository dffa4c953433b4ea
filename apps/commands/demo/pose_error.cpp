// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/commands/demo/pose_error.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

Eigen::Vector3d random_direction(Random& random) {
  Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
  return direction.normalized();
}

double distance_mm(const RigidTransform& a, const RigidTransform& b) {
  return 1000 * (a.translation - b.translation).norm();
}

double angle_deg(const RigidTransform& a, const RigidTransform& b) {
  return rotation_angle(a.inverse() * b) / kDegrees.factor;
}

/// Of the pair that the scan has most in common with [m].
double best_rms(const RegisterScansResult& result, std::size_t scan) {
  double rms = 0;
  double overlap = 0;
  for (const ScanEdge& edge : result.edges) {
    const bool takes_part = edge.edge.from == scan || edge.edge.to == scan;
    if (!takes_part || edge.verdict != EdgeVerdict::kKept || edge.overlap <= overlap) continue;
    overlap = edge.overlap;
    rms = edge.inlier_rms;
  }
  return rms;
}

double position_sigma(const ScanPlacement& place) {
  return std::sqrt(std::max(0.0, place.covariance.diagonal().head<3>().maxCoeff()));
}

}  // namespace

RigidTransform rough_pose(const RigidTransform& world_from_scan,
                          std::uint64_t scan,
                          const DemoSettings& settings) {
  Random random(settings.seed, 1000 + scan);
  const Eigen::Vector3d shift = settings.start_distance * random_direction(random);
  const Eigen::AngleAxisd turn(settings.start_angle, random_direction(random));
  return {Eigen::Quaterniond(turn) * world_from_scan.rotation, world_from_scan.translation + shift};
}

void report_pose_errors(const std::vector<RecordedScan>& scans,
                        const ScanProject& registered,
                        const RegisterScansResult& result,
                        Figures& figures) {
  FigureTable table{"poses",
                    "",
                    {{"name", "scan", 0},
                     {"start_error_mm", "before", 2},
                     {"start_error_deg", "before", 4},
                     {"pose_error_mm", "after", 3},
                     {"pose_error_deg", "after", 5},
                     {"rms_mm", "rms", 3},
                     {"overlap_percent", "overlap", 1},
                     {"position_sigma_mm", "sigma", 4}},
                    {}};
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const RigidTransform& truth = scans[i].true_world_from_scan;
    const RigidTransform& start = scans[i].extracted.scan.world_from_scan;
    const RigidTransform& found = registered.scans[i].world_from_scan;
    const ScanPlacement& place = result.scans[i];
    table.rows.push_back({scans[i].name,
                          distance_mm(start, truth),
                          angle_deg(start, truth),
                          distance_mm(found, truth),
                          angle_deg(found, truth),
                          1000 * best_rms(result, i),
                          100 * place.overlap,
                          1000 * position_sigma(place)});
  }
  figures.table(std::move(table));
}

}  // namespace facula
