// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/tests/map/drawn_map.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kCell = 0.1;
constexpr auto kFree = NavigationGrid::kFree;
constexpr auto kOccupied = NavigationGrid::kOccupied;
constexpr auto kUnknown = NavigationGrid::kUnknown;

Eigen::Vector3f centre(int x, int y, int z) {
  return ((Eigen::Vector3d(x, y, z).array() + 0.5) * kCell).cast<float>();
}

void add_ray(PointCloud& cloud, const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  cloud.sensor_origin.push_back(from);
  cloud.points.push_back(to);
}

/// Seen from cell (2, 1): a post 4 cells along +x and one 2 cells along +y, at cell height 5; a
/// table top at height 30 (above the band) over cell (0, 1), with the floor below it free.
OccupancyMap corner_scene() {
  PointCloud cloud;
  add_ray(cloud, centre(2, 1, 5), centre(6, 1, 5));
  add_ray(cloud, centre(2, 1, 5), centre(2, 3, 5));
  add_ray(cloud, centre(0, 1, 5), centre(0, 1, 30));
  OccupancyMap map({.resolution = kCell});
  map.insert(cloud);
  return map;
}

TEST(NavigationGrid, LooksDownOnTheSceneWithYUpwards) {
  const NavigationGrid grid = navigation_grid(corner_scene());
  ASSERT_EQ(grid.cols, 7);
  ASSERT_EQ(grid.rows, 3);
  EXPECT_NEAR(grid.origin.x(), 0.0, 1e-9);
  EXPECT_NEAR(grid.origin.y(), 0.1, 1e-9);
  const std::vector<std::uint8_t> expected = {
      kUnknown, kUnknown, kOccupied, kUnknown, kUnknown, kUnknown, kUnknown,   // y = 3
      kUnknown, kUnknown, kFree,     kUnknown, kUnknown, kUnknown, kUnknown,   // y = 2
      kFree,    kUnknown, kFree,     kFree,    kFree,    kFree,    kOccupied,  // y = 1
  };
  EXPECT_EQ(grid.cells, expected);
}

TEST(NavigationGrid, TakesOnlyTheHeightsItIsAskedFor) {
  const OccupancyMap map = corner_scene();
  const NavigationGrid high = navigation_grid(map, {.min_height = 2.9, .max_height = 3.5});
  ASSERT_EQ(high.cells.size(), 1U + 0U);
  EXPECT_EQ(high.cells[0], kOccupied);
  // A band that only shares a face with a cell does not contain it.
  const NavigationGrid below = navigation_grid(map, {.min_height = 0.6, .max_height = 3.0});
  ASSERT_EQ(below.cells.size(), 1U);
  EXPECT_EQ(below.cells[0], kFree);
}

TEST(NavigationGrid, PaintsPrunedLeavesInFull) {
  PointCloud cloud;
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      add_ray(cloud, centre(x, y, -1), centre(x, y, 4));
    }
  }
  OccupancyMap map({.resolution = kCell});
  map.insert(cloud);
  double largest = 0;
  map.for_each_leaf(
      [&](const Eigen::Vector3d&, CellState, double edge) { largest = std::max(largest, edge); });
  ASSERT_GT(largest, 3.9 * kCell) << "nothing was pruned: the test tests nothing";
  const NavigationGrid grid = navigation_grid(map, {.min_height = 0.05, .max_height = 0.35});
  EXPECT_EQ(grid.cells, std::vector<std::uint8_t>(16, kFree));
}

TEST(NavigationGrid, SaysThatNothingWasSeenBetweenTheHeights) {
  const OccupancyMap map = corner_scene();
  const auto grid_at = [&](double low, double high) {
    return error_of([&] { navigation_grid(map, {.min_height = low, .max_height = high}); });
  };
  EXPECT_NE(grid_at(50, 51).find("no known cell"), std::string::npos);
  EXPECT_NE(grid_at(1, 1).find("max_height"), std::string::npos);
  EXPECT_NE(error_of([] { navigation_grid(OccupancyMap{}); }).find("no known cell"),
            std::string::npos);
}

/// One column per log-odds, from left to right, in cells of 0.1 m.
OccupancyMap row_of_columns(const std::vector<float>& log_odds) {
  DrawnMap drawn(kCell);
  for (int x = 0; x < static_cast<int>(log_odds.size()); ++x) {
    drawn.paint({{x, 0, 3}, {x + 1, 1, 4}}, log_odds[static_cast<std::size_t>(x)]);
  }
  return drawn.map();
}

TEST(NavigationGrid, GivesEveryColumnItsLargestProbabilityInPercent) {
  // Probabilities by hand: 1 / (1 + e^2) = 0.1192, 1 / (1 + e^-3.5) = 0.9707.
  EXPECT_EQ(navigation_grid(row_of_columns({-2, 3.5F})).occupancy,
            (std::vector<std::int8_t>{12, 97}));
  DrawnMap column(kCell);
  column.paint({{0, 0, 2}, {1, 1, 9}}, -2);
  column.paint({{0, 0, 5}, {1, 1, 6}}, 0.847298F);  // 0.7
  column.paint({{0, 0, 7}, {1, 1, 8}}, -0.405465F);
  const NavigationGrid grid = navigation_grid(column.map());
  EXPECT_EQ(grid.occupancy, std::vector<std::int8_t>{70});
  EXPECT_EQ(grid.cells, std::vector<std::uint8_t>{kOccupied});
}

TEST(NavigationGrid, RoundsProbabilitiesToTheSideTheirStateIsOn) {
  const NavigationGrid grid = navigation_grid(row_of_columns({-0.001F, 0, 0.001F}));
  EXPECT_EQ(grid.occupancy, (std::vector<std::int8_t>{49, 50, 50}));
  EXPECT_EQ(grid.cells, (std::vector<std::uint8_t>{kFree, kOccupied, kOccupied}));
}

TEST(NavigationGrid, MarksUnknownColumnsInBothForms) {
  DrawnMap drawn(kCell);
  drawn.free({{0, 0, 3}, {1, 1, 4}});
  drawn.free({{2, 0, 3}, {3, 1, 4}});
  const NavigationGrid grid = navigation_grid(drawn.map());
  EXPECT_EQ(grid.cells, (std::vector<std::uint8_t>{kFree, kUnknown, kFree}));
  EXPECT_EQ(grid.occupancy, (std::vector<std::int8_t>{12, -1, 12}));
}

/// Cells within `radius` of an occupied one, by looking at every pair.
std::vector<std::uint8_t> inflated_by_pairs(const NavigationGrid& grid, double radius) {
  std::vector<std::uint8_t> cells = grid.cells;
  const auto at = [&](int row, int col) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.cols) +
           static_cast<std::size_t>(col);
  };
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      for (int r = 0; r < grid.rows; ++r) {
        for (int c = 0; c < grid.cols; ++c) {
          const double squared = (r - row) * (r - row) + (c - col) * (c - col);
          const double reach = radius / grid.resolution;
          if (grid.cells[at(r, c)] == kOccupied && squared <= reach * reach + 1e-6) {
            cells[at(row, col)] = kOccupied;
          }
        }
      }
    }
  }
  return cells;
}

NavigationGrid random_grid(std::uint64_t seed) {
  Random random(seed);
  NavigationGrid grid{.rows = 23, .cols = 31, .resolution = 0.05, .origin = {1, 2}, .cells = {}};
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double draw = random.uniform();
    grid.cells.push_back(draw < 0.02 ? kOccupied : draw < 0.3 ? kUnknown : kFree);
    grid.occupancy.push_back(draw < 0.02 ? 80 : draw < 0.3 ? -1 : 12);
  }
  return grid;
}

TEST(InflateGrid, TakesInTheCellsThatEveryPairSaysAreNear) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const double radius : {0.0, 0.049, 0.05, 0.08, 0.15, 0.25, 0.8, 100.0}) {
      NavigationGrid grid = random_grid(seed);
      const std::vector<std::uint8_t> expected = inflated_by_pairs(grid, radius);
      inflate(grid, radius);
      EXPECT_EQ(grid.cells, expected) << "seed " << seed << ", radius " << radius;
    }
  }
}

TEST(InflateGrid, MakesAPostADisc) {
  NavigationGrid grid{.rows = 5, .cols = 5, .resolution = 0.1, .origin = {0, 0}, .cells = {}};
  grid.cells.assign(25, kFree);
  grid.occupancy.assign(25, 12);
  grid.cells[12] = kOccupied;
  grid.occupancy[12] = 97;
  inflate(grid, 0.2);
  const std::string expected =
      "..#.."
      ".###."
      "#####"
      ".###."
      "..#..";
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_EQ(grid.cells[i], expected[i] == '#' ? kOccupied : kFree) << i;
    EXPECT_EQ(grid.occupancy[i], expected[i] == '#' ? 100 : 12) << i;
  }
}

TEST(InflateGrid, LeavesAnEmptyGridAndOneWithoutObstaclesAlone) {
  NavigationGrid empty;
  inflate(empty, 1);
  EXPECT_TRUE(empty.cells.empty());
  NavigationGrid grid{.rows = 1, .cols = 2, .resolution = 1, .origin = {0, 0}, .cells = {}};
  grid.cells = {kFree, kUnknown};
  inflate(grid, 10);
  EXPECT_EQ(grid.cells, (std::vector<std::uint8_t>{kFree, kUnknown}));
  EXPECT_NE(error_of([&] { inflate(grid, -1); }).find("radius"), std::string::npos);
}

}  // namespace
}  // namespace facula
