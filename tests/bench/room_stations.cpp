// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/acquire/simulate/simulate.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/reconstruct/filter/scan_filters.hpp>
#include <facula/tests/bench/room_stations.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <numbers>
#include <string>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

PosedCloud seen_room(const Scene& scene,
                     const Rig& rig,
                     const SimulatedRun& run,
                     std::uint64_t seed) {
  const TemporaryFolder folder;
  SimulateOptions options = options_for(rig);
  options.seed = seed;
  simulate_capture(folder / "capture", scene, rig, run, options);
  PolarScan scan = extract_scan(read_capture(folder / "capture")).scan;
  remove_mixed_points(scan);
  PosedCloud seen;
  seen.cloud = cloud_from_scan(scan);
  seen.grid = grid_from_scan(scan);
  return seen;
}

}  // namespace

std::vector<RigidTransform> room_stations() {
  std::vector<RigidTransform> poses;
  const double places[8][3] = {{-1.5, -0.3, 0},
                               {0.2, 0.8, 120},
                               {1.7, -0.3, -75},
                               {-0.3, -0.2, 200},
                               {-1.2, 0.8, 40},
                               {0.8, -0.2, 310},
                               {1.9, 0.7, 160},
                               {-0.7, 0.4, 265}};
  for (const auto& [x, y, yaw] : places) {
    poses.push_back({Eigen::Quaterniond(Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitZ())),
                     {x, y, 1.1}});
  }
  return poses;
}

KnownProject eight_stations(double step) {
  const Scene scene = read_scene(shipped_data("scenes/furnished_room.toml"));
  const Rig rig = read_rig(shipped_data("rigs/head_fs1500.toml"));
  KnownProject known;
  known.truth = room_stations();
  std::vector<double> positions;
  for (double angle = 0; angle < 2 * std::numbers::pi - step / 2; angle += step) {
    positions.push_back(angle);
  }
  for (const RigidTransform& pose : known.truth) {
    const std::size_t number = known.project.scans.size() + 1;
    known.project.scans.push_back(seen_room(scene, rig, {pose, positions}, number));
    known.project.scans.back().name = "station" + std::to_string(number);
  }
  return known;
}

}  // namespace facula
