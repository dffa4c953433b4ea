// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/short_ways.hpp>
#include <facula/tests/map/made_map.hpp>
#include <facula/tests/map/steps_by_queue.hpp>

#include <set>

#include <gtest/gtest.h>

namespace facula {
namespace {

const CellBox kBox{near_centre(0, 0, 0), near_centre(24, 19, 6)};
constexpr double kRadius = 0.12;

bool beside(const CellKey& cell, const CellKey& end) {
  return grown({end, end}, 1).contains(cell);
}

/// Cells that ways go over.
bool is_open(const Clearance& clearance, const std::array<CellKey, 2>& ends, const CellKey& cell) {
  const bool near_end = beside(cell, ends[0]) || beside(cell, ends[1]);
  return kBox.contains(cell) && (clearance.holds_at_centre(cell, kRadius) ||
                                 (near_end && clearance.may_hold(cell, kRadius)));
}

TEST(ShortWays, AreTheCellsWhoseStepsToBothEndsAreFewEnough) {
  Random random(31);
  const std::array<CellKey, 2> ends = {near_centre(2, 2, 3), near_centre(21, 15, 3)};
  int connected = 0;
  for (int round = 0; round < 10; ++round) {
    OccupancyMap map = random_map(random, kBox, {.unknown = 0, .occupied = 0.002 * (round + 1)});
    for (const CellKey& end : ends) {
      for_each_cell_of(grown({end, end}, 1),
                       [&](const CellKey& cell) { set_cell(map, cell, kFreeValue); });
    }
    const Clearance clearance(map, {.unknown = UnknownCells::kFree});
    const auto cells = cells_of_short_ways(
        clearance, kBox, ends, {.radius = kRadius, .detour = 0.2, .num_threads = 1 + round % 2});
    const auto open = [&](const CellKey& cell) { return is_open(clearance, ends, cell); };
    const auto from_start = steps_by_queue(ends[0], open);
    const auto from_goal = steps_by_queue(ends[1], open);
    std::set<CellKey> truth;
    if (from_start.contains(ends[1])) {
      ++connected;
      const int least = from_start.at(ends[1]);
      const int most = least + static_cast<int>(0.2 * least);
      for (const auto& [cell, steps] : from_start) {
        if (from_goal.contains(cell) && steps + from_goal.at(cell) <= most) truth.insert(cell);
      }
    }
    EXPECT_EQ(std::set<CellKey>(cells.begin(), cells.end()), truth) << round;
    EXPECT_EQ(cells.size(), truth.size()) << round;
  }
  EXPECT_GE(connected, 3);
}

TEST(ShortWays, AreNoneThroughAClosedWall) {
  OccupancyMap map = OccupancyMap({.resolution = 0.1});
  for_each_cell_of(kBox, [&](const CellKey& cell) {
    set_cell(map, cell, cell[0] == kCentreKey + 12 ? kOccupiedValue : kFreeValue);
  });
  const Clearance clearance(map, {.unknown = UnknownCells::kFree});
  const std::array<CellKey, 2> ends = {near_centre(2, 2, 3), near_centre(21, 15, 3)};
  EXPECT_TRUE(cells_of_short_ways(clearance, kBox, ends, {.radius = kRadius}).empty());
}

}  // namespace
}  // namespace facula
