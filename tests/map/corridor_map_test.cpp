// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/navigation_grid.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// Three posed scans of a corridor (3DTK's dat) as a map of 5 cm cells, one insert() per scan.
OccupancyMap corridor_map(const ScanProject& project) {
  OccupancyMap map({.resolution = 0.05});
  for (const PosedCloud& scan : project.scans) {
    map.insert(transformed(scan.cloud, scan.world_from_scan));
  }
  return map;
}

TEST(CorridorMap, GoesFromPosedScansToTheFilesARobotReads) {
  FACULA_REQUIRE_REAL_DATA(folder_3dtk, "range/3dtk-dat");
  const ScanProject project = read_scan_project(folder_3dtk);
  ASSERT_EQ(project.scans.size(), 3U);
  const OccupancyMap map = corridor_map(project);
  EXPECT_EQ(map.skipped_points(), 0U);

  const TemporaryFolder folder;
  map.write(folder / "corridor.bt");
  octomap::OcTree tree(1.0);
  ASSERT_TRUE(tree.readBinary((folder / "corridor.bt").string()));
  EXPECT_EQ(tree.getResolution(), 0.05);
  std::size_t disagree = 0;
  map.for_each_leaf([&](const Eigen::Vector3d& x, CellState state, double) {
    const auto* node = tree.search(x.x(), x.y(), x.z());
    const bool occupied = node != nullptr && tree.isNodeOccupied(node);
    if (node == nullptr || occupied != (state == CellState::kOccupied)) ++disagree;
  });
  EXPECT_EQ(disagree, 0U);

  const NavigationGrid grid = navigation_grid(map);
  write_navigation_grid(folder / "corridor.yaml", grid);
  EXPECT_EQ(read_navigation_grid(folder / "corridor.yaml").cells, grid.cells);
}

TEST(CorridorMap, HoldsTheScannerInFreeSpaceBetweenWallsAsFarApartAsMeasured) {
  FACULA_REQUIRE_REAL_DATA(folder_3dtk, "range/3dtk-dat");
  const ScanProject project = read_scan_project(folder_3dtk);
  const OccupancyMap map = corridor_map(project);
  for (const PosedCloud& scan : project.scans) {
    EXPECT_EQ(map.state(scan.world_from_scan.translation), CellState::kFree) << scan.name;
  }
  // The first scan drives the others: x is forward, y to the left. Walls found by plane fits on
  // the scan stand 4.75 m apart and are parallel to 0.17 degrees (the set's notes).
  const Eigen::Vector3d start = project.scans[0].world_from_scan.translation;
  const auto first_occupied = [&](double step) {
    for (double y = 0; std::abs(y) < 5; y += step) {
      const Eigen::Vector3d x = start + Eigen::Vector3d(0.5, y, 0.6);
      if (map.state(x) == CellState::kOccupied) return y;
    }
    return 99.0;
  };
  const double width = first_occupied(0.025) - first_occupied(-0.025);
  EXPECT_NEAR(width, 4.75, 0.3);
}

/// Share of the points whose cell is occupied and share of ray cells (sampled) that are free.
TEST(CorridorMap, AgreesWithItsOwnRays) {
  FACULA_REQUIRE_REAL_DATA(folder_3dtk, "range/3dtk-dat");
  const ScanProject project = read_scan_project(folder_3dtk);
  const OccupancyMap map = corridor_map(project);
  double occupied = 0;
  double ends = 0;
  double free = 0;
  double samples = 0;
  for (const PosedCloud& scan : project.scans) {
    const PointCloud cloud = transformed(scan.cloud, scan.world_from_scan);
    for (std::size_t i = 0; i < cloud.size(); i += 50) {
      const Eigen::Vector3d end = cloud.points[i].cast<double>();
      const Eigen::Vector3d origin = cloud.sensor_origin[i].cast<double>();
      ends += 1;
      occupied += map.state(end) == CellState::kOccupied ? 1 : 0;
      for (double at = 0.05; at < 0.95; at += 0.1) {
        samples += 1;
        free += map.state(origin + at * (end - origin)) == CellState::kFree ? 1 : 0;
      }
    }
  }
  // Hornung et al. (2013) report 97.3 % overall for FR-079 at 5 cm. Here the poses are only good to
  // centimetres (the set's notes), which costs end points.
  EXPECT_GT((occupied + free) / (ends + samples), 0.95)
      << occupied / ends << " of the ends, " << free / samples << " of the samples";
}

}  // namespace
}  // namespace facula
