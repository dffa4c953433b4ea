// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/find_floor.hpp>
#include <facula/map/frontiers.hpp>
#include <facula/map/height_map.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// Two maps of floors of the same building (Freiburg, 079), with the extents of the set's notes.
struct KnownMap {
  const char* file;
  double length;  ///< of the known space [m]
  double width;   ///< [m]
};
constexpr KnownMap kCorridor = {"fr_079.bt", 43.7, 18.2};
constexpr KnownMap kOffices = {"geb079.bt", 38.96, 14.96};

class RealFloors : public testing::TestWithParam<KnownMap> {};

TEST_P(RealFloors, AreFoundWhereTheRobotsDrove) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/octomap-maps");
  const OccupancyMap map = OccupancyMap::read(folder / GetParam().file);
  const Floor floor = find_floor(map);
  // Both maps count heights from the floor, which the robots' lasers saw one or two cells thick.
  EXPECT_NEAR(floor.height, 0, 2 * map.resolution());
  EXPECT_LT(floor.spread, map.resolution());
  // The robots' lasers saw the floor of a good part of the free space, and nothing else is as flat.
  const NavigationGrid grid =
      navigation_grid(map, {.min_height = floor.top, .max_height = floor.top + 0.5});
  const auto free = std::count(grid.cells.begin(), grid.cells.end(), NavigationGrid::kFree);
  const double free_area = static_cast<double>(free) * std::pow(map.resolution(), 2);
  EXPECT_GT(floor.area, 0.3 * free_area);
  EXPECT_LT(floor.area, 1.0 * free_area);
}

TEST_P(RealFloors, GiveGridsAsLargeAsTheBuilding) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/octomap-maps");
  const OccupancyMap map = OccupancyMap::read(folder / GetParam().file);
  const NavigationGrid all = navigation_grid(map, {.min_height = -100, .max_height = 100});
  EXPECT_NEAR(all.cols * all.resolution, GetParam().length, 1e-9);
  EXPECT_NEAR(all.rows * all.resolution, GetParam().width, 1e-9);
  const HeightMap heights = height_map(map);
  EXPECT_EQ(heights.cols, all.cols);
  EXPECT_EQ(heights.rows, all.rows);

  const Floor floor = find_floor(map);
  const NavigationGrid band = navigation_grid(
      map, {.min_height = floor.top + 0.1, .max_height = floor.top + 1.5, .inflation = 0.3});
  EXPECT_LE(band.cols, all.cols);
  const TemporaryFolder scratch;
  for (const GridMode mode : {GridMode::kTrinary, GridMode::kRaw}) {
    write_navigation_grid(scratch / "map.yaml", band, {.mode = mode});
    const NavigationGrid back = read_navigation_grid(scratch / "map.yaml");
    EXPECT_EQ(back.cells, band.cells);
    EXPECT_EQ(back.origin, band.origin);
  }
}

/// Every column, cell by cell through OccupancyMap::state().
TEST_P(RealFloors, HaveGridsAndHeightsThatTheCellsConfirm) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/octomap-maps");
  const OccupancyMap map = OccupancyMap::read(folder / GetParam().file);
  const double cell = map.resolution();
  const NavigationGrid grid =
      navigation_grid(map, {.min_height = 2 * cell, .max_height = 20 * cell});
  const HeightMap heights = height_map(map, {.max_height = 20 * cell});
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < grid.size(); i += 7) {
    const auto cols = static_cast<std::size_t>(grid.cols);
    const double x = grid.origin.x() + (static_cast<double>(i % cols) + 0.5) * cell;
    const double y = grid.origin.y() + (grid.rows - 1 - static_cast<double>(i / cols) + 0.5) * cell;
    std::uint8_t expected = NavigationGrid::kUnknown;
    float top = std::nanf("");
    for (int layer = -20; layer < 20; ++layer) {
      const CellState state = map.state({x, y, (layer + 0.5) * cell});
      if (state == CellState::kOccupied) top = static_cast<float>((layer + 1) * cell);
      if (layer < 2 || state == CellState::kUnknown) continue;
      if (state == CellState::kOccupied)
        expected = NavigationGrid::kOccupied;
      else if (expected == NavigationGrid::kUnknown)
        expected = NavigationGrid::kFree;
    }
    if (grid.cells[i] != expected) ++wrong;
    const auto col = static_cast<std::size_t>((x - heights.origin.x()) / cell);
    const int row = heights.rows - 1 - static_cast<int>((y - heights.origin.y()) / cell);
    const float found =
        heights.top[static_cast<std::size_t>(row) * static_cast<std::size_t>(heights.cols) + col];
    if (!(found == top || (std::isnan(found) && std::isnan(top)))) ++wrong;
  }
  EXPECT_EQ(wrong, 0U);
}

TEST_P(RealFloors, HaveFrontiersThatATripodCouldStandNear) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/octomap-maps");
  const OccupancyMap map = OccupancyMap::read(folder / GetParam().file);
  FrontierOptions options;
  options.stand.most = 40;
  options.range = 6;
  options.count = 3;
  const Frontiers found = find_frontiers(map, find_floor(map), options);
  ASSERT_EQ(found.suggestions.size(), 3U);
  for (const ScanSuggestion& suggestion : found.suggestions) {
    EXPECT_EQ(map.state(suggestion.position), CellState::kFree);
    EXPECT_GT(suggestion.volume, 1);
    EXPECT_LE(suggestion.region_volume, suggestion.volume);
    EXPECT_LE((suggestion.region.centre - suggestion.position).norm(), options.range + 2);
  }
}

/// The maps were made of other drives at another resolution; what they leave unseen is the same.
TEST(RealFrontiers, AreTheSameRoomsInBothMapsOfABuilding) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/octomap-maps");
  std::array<std::vector<ScanSuggestion>, 2> found;
  for (std::size_t i = 0; i < 2; ++i) {
    const OccupancyMap map = OccupancyMap::read(folder / (i == 0 ? kCorridor : kOffices).file);
    found[i] = find_frontiers(map, find_floor(map), {.count = 1}).suggestions;
    ASSERT_EQ(found[i].size(), 1U);
  }
  const Eigen::Vector3d apart = found[0][0].position - found[1][0].position;
  EXPECT_LT(apart.norm(), 1.0);
  EXPECT_NEAR(found[0][0].volume, found[1][0].volume, 0.2 * found[0][0].volume);
}

INSTANTIATE_TEST_SUITE_P(Building079,
                         RealFloors,
                         testing::Values(kCorridor, kOffices),
                         [](const auto& known) {
                           const std::string file = known.param.file;
                           return file.substr(0, file.find('.'));
                         });

}  // namespace
}  // namespace facula
