// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/reachable_cells.hpp>
#include <facula/tests/map/made_map.hpp>
#include <facula/tests/map/steps_by_queue.hpp>

#include <set>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(ReachableCells, AreThoseOfASearchCellByCell) {
  Random random(17);
  for (int round = 0; round < 8; ++round) {
    const CellBox box{near_centre(-70, -5, -6), near_centre(75, 9, 7)};
    const OccupancyMap map =
        random_map(random, box, {.unknown = 0, .occupied = 0.05 * (round + 2)});
    const Clearance clearance(map, {.unknown = UnknownCells::kFree});
    CellKey first = near_centre(0, 0, 0);
    while (!clearance.may_hold(first, 0.01)) ++first[0];
    const ReachableCells reachable(clearance, box, first, 0.01, 1 + round % 2);
    const auto truth = steps_by_queue(first, [&](const CellKey& cell) {
      return box.contains(cell) && clearance.may_hold(cell, 0.01);
    });
    ASSERT_EQ(reachable.size(), truth.size()) << round;
    std::set<CellKey> listed;
    for (std::size_t i = 0; i < reachable.size(); ++i) listed.insert(reachable[i]);
    EXPECT_EQ(listed.size(), truth.size()) << round;
    for (const CellKey& cell : listed) EXPECT_TRUE(truth.contains(cell)) << round;
    for_each_cell_of(box, [&](const CellKey& cell) {
      if (reachable.contains(cell) != truth.contains(cell)) ADD_FAILURE() << round;
    });
    EXPECT_FALSE(reachable.contains(near_centre(76, 0, 0)));
  }
}

TEST(ReachableCells, AreNoneFromWithinAnObstacle) {
  OccupancyMap map({.resolution = 0.1});
  const CellBox box{near_centre(0, 0, 0), near_centre(5, 5, 5)};
  for_each_cell_of(box, [&](const CellKey& cell) { set_cell(map, cell, kFreeValue); });
  set_cell(map, near_centre(2, 2, 2), kOccupiedValue);
  const Clearance clearance(map, {.unknown = UnknownCells::kFree});
  EXPECT_EQ(ReachableCells(clearance, box, near_centre(2, 2, 2), 0.01).size(), 0U);
  EXPECT_EQ(ReachableCells(clearance, box, near_centre(0, 0, 0), 0.01).size(), 215U);
}

}  // namespace
}  // namespace facula
