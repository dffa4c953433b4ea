// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/reconstruct/simulated_pair.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace facula {
namespace {

using Json = nlohmann::json;

constexpr double kCell = 0.1;

/// Two scans of a room whose files know nothing of where they stand to each other.
class MapRegisters : public testing::Test {
 protected:
  MapRegisters() : pair_(simulate_pair()) {
    write_cloud(folder_ / "one.ply", pair_.target.cloud);
    write_cloud(folder_ / "two.ply", pair_.source.cloud);
  }

  Json figures_of(const std::string& options) const {
    const ProgramRun done = run_line(
        "facula map one.ply two.ply --resolution-mm 100 --json - " + options, folder_.path());
    EXPECT_EQ(done.code, 0) << done.err;
    return Json::parse(done.out, nullptr, false);
  }

  /// The map of both scans where they truly stand, in the frame of the first.
  OccupancyMap true_map() const {
    OccupancyMap map({.resolution = kCell});
    map.insert(pair_.target.cloud);
    map.insert(transformed(pair_.source.cloud, pair_.target_from_source));
    return map;
  }

  TemporaryFolder folder_;
  SimulatedPair pair_;
};

bool is_occupied_near(const OccupancyMap& map, const Eigen::Vector3d& x) {
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d way(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (map.state(x + kCell * way) == CellState::kOccupied) return true;
  }
  return false;
}

/// The share of one map's occupied cells that have one of the other's within a cell [1].
double share_found(const OccupancyMap& map, const OccupancyMap& in) {
  std::size_t cells = 0;
  std::size_t found = 0;
  map.for_each_leaf([&](const Eigen::Vector3d& centre, CellState state, double edge) {
    if (state != CellState::kOccupied || edge > 1.5 * kCell) return;
    ++cells;
    if (is_occupied_near(in, centre)) ++found;
  });
  return static_cast<double>(found) / static_cast<double>(cells);
}

TEST_F(MapRegisters, ScansWithoutPosesBeforeItMapsThem) {
  const Json figures = figures_of("--out map.ot");
  EXPECT_EQ(figures.at("registered"), 2);
  EXPECT_EQ(figures.at("left_out"), 0);
  const OccupancyMap map = OccupancyMap::read(folder_ / "map.ot");
  EXPECT_GT(share_found(map, true_map()), 0.999);
  EXPECT_GT(share_found(true_map(), map), 0.999);
}

TEST_F(MapRegisters, NothingWhereItIsToldNotTo) {
  EXPECT_FALSE(figures_of("--register never --out map.ot").contains("registered"));
  EXPECT_LT(share_found(OccupancyMap::read(folder_ / "map.ot"), true_map()), 0.9);
}

TEST_F(MapRegisters, SaysThatItCannotPlaceScansThatShareNothing) {
  PointCloud wall;
  for (int i = 0; i < 1000; ++i) {
    wall.points.emplace_back(
        50.0F, 0.02F * static_cast<float>(i % 40), 0.02F * static_cast<float>(i / 40));
  }
  write_cloud(folder_ / "wall.ply", wall);
  expect_refused(run_line("facula map one.ply wall.ply --out x.bt", folder_.path()),
                 1,
                 "no two of them could be registered");
}

}  // namespace
}  // namespace facula
