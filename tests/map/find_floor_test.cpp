// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/map/find_floor.hpp>
#include <facula/tests/map/drawn_map.hpp>
#include <facula/tests/support/matchers.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kCell = 0.05;

/// 4 m x 3 m x 2.5 m, its floor in layer `floor`.
DrawnMap room(int floor) {
  DrawnMap drawn(kCell);
  drawn.room({{0, 0, floor + 1}, {80, 60, floor + 51}});
  return drawn;
}

TEST(FindFloor, FindsTheFloorOfAnEmptyRoomToTheCell) {
  for (const int layer : {-40, -1, 0, 6, 7, 8, 123}) {  // 7: its free cells are in another brick
    const Floor floor = find_floor(room(layer).map());
    EXPECT_NEAR(floor.height, (layer + 0.5) * kCell, 1e-9);
    EXPECT_NEAR(floor.top, (layer + 1) * kCell, 1e-9);
    EXPECT_NEAR(floor.area, 4.0 * 3.0, 1e-9);
    EXPECT_NEAR(floor.share, 80.0 * 60.0 / (82.0 * 62.0), 1e-9);  // walls are columns too
    EXPECT_EQ(floor.spread, 0);
  }
}

TEST(FindFloor, IsNotTakenInByTablesClutterAndWhatLiesBelow) {
  DrawnMap drawn = room(0);
  drawn.occupy({{10, 10, 14}, {40, 50, 15}});  // a table of 3 m^2
  drawn.free({{60, 0, -30}, {64, 60, -20}});   // a shaft seen through a grating: 0.6 m^2
  drawn.occupy({{60, 0, -31}, {64, 60, -30}});
  Random random(7);
  for (int i = 0; i < 2000; ++i) {  // things on the floor and reflections below it
    const int x = static_cast<int>(random.below(79));
    const int y = static_cast<int>(random.below(59));
    const int z = static_cast<int>(random.below(40)) - 20;
    if (z == 0 || z == 1) continue;
    drawn.occupy({{x, y, z}, {x + 1, y + 1, z + 1}});
  }
  EXPECT_NEAR(find_floor(drawn.map()).height, 0.5 * kCell, 0.3 * kCell);
}

TEST(FindFloor, TakesTheLowerOfTwoStoreys) {
  DrawnMap drawn = room(0);
  drawn.room({{0, 0, 60}, {80, 60, 100}});
  EXPECT_NEAR(find_floor(drawn.map()).height, 0.5 * kCell, 1e-9);
}

/// A floor that climbs `rise` cells over its 80 columns.
DrawnMap tilted_room(int rise) {
  DrawnMap drawn(kCell);
  for (int x = 0; x < 80; ++x) {
    const int z = x * (rise + 1) / 80;
    drawn.occupy({{x, 0, z}, {x + 1, 60, z + 1}});
    drawn.free({{x, 0, z + 1}, {x + 1, 60, 50}});
  }
  return drawn;
}

TEST(FindFloor, StandsASmallTilt) {
  for (const int rise : {1, 2}) {
    const Floor floor = find_floor(tilted_room(rise).map());
    EXPECT_NEAR(floor.height, (0.5 + rise / 2.0) * kCell, 0.02 * kCell);
    EXPECT_NEAR(floor.top, (rise + 1) * kCell, 1e-9);
    EXPECT_NEAR(floor.area, 12.0, 1e-9);
  }
  // Two layers, each half: 0.5 cells. Three layers, 27 + 27 + 26 columns: sqrt(2 / 3) cells.
  EXPECT_NEAR(find_floor(tilted_room(1).map()).spread, 0.5 * kCell, 1e-9);
  EXPECT_NEAR(find_floor(tilted_room(2).map()).spread, std::sqrt(2.0 / 3) * kCell, 0.01 * kCell);
}

TEST(FindFloor, KeepsThingsThatLieOnTheFloorOutOfItsTop) {
  DrawnMap drawn = room(0);
  drawn.occupy({{10, 10, 1}, {14, 14, 2}});  // a book of 0.2 m x 0.2 m
  EXPECT_NEAR(find_floor(drawn.map()).top, kCell, 1e-9);
}

TEST(FindFloor, SaysThatThereIsNoFloor) {
  EXPECT_NE(error_of([] { find_floor(OccupancyMap{}); }).find("no floor"), std::string::npos);
  DrawnMap wall(kCell);  // seen from the side: nothing faces up but its crest
  wall.occupy({{0, 0, 0}, {1, 80, 40}});
  wall.free({{1, 0, 0}, {40, 80, 40}});
  EXPECT_NE(error_of([&] { find_floor(wall.map()); }).find("1 m^2 or more"), std::string::npos);
  DrawnMap ceiling(kCell);
  ceiling.free({{0, 0, 0}, {80, 80, 40}});
  ceiling.occupy({{0, 0, 40}, {80, 80, 41}});
  EXPECT_NE(error_of([&] { find_floor(ceiling.map()); }).find("no floor"), std::string::npos);
}

TEST(FindFloor, NamesOptionsThatCannotBe) {
  const OccupancyMap map = room(0).map();
  EXPECT_NE(error_of([&] { find_floor(map, {.min_area = 0}); }).find("min_area"),
            std::string::npos);
  EXPECT_NE(error_of([&] { find_floor(map, {.min_share = 2}); }).find("min_share"),
            std::string::npos);
  EXPECT_NE(error_of([&] { find_floor(map, {.layers = 0}); }).find("layers"), std::string::npos);
}

}  // namespace
}  // namespace facula
