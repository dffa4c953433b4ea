// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/map/distance_field.hpp>
#include <facula/map/distance_transform.hpp>
#include <facula/tests/map/made_map.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

bool is_obstacle(const OccupancyMap& map, const CellKey& cell, UnknownCells unknown) {
  const CellState state = map.state_of_cell(cell);
  return state == CellState::kOccupied ||
         (state == CellState::kUnknown && unknown == UnknownCells::kOccupied);
}

/// Signed squared distance in cells by looking at every cell; 0 when no cell is of the other kind.
int by_brute_force(const OccupancyMap& map,
                   const CellBox& box,
                   UnknownCells unknown,
                   const CellKey& from) {
  const bool inside = is_obstacle(map, from, unknown);
  int nearest = 0;
  for_each_cell_of(box, [&](const CellKey& to) {
    if (is_obstacle(map, to, unknown) == inside) return;
    int squared = 0;
    for (std::size_t i = 0; i < 3; ++i) squared += (to[i] - from[i]) * (to[i] - from[i]);
    if (nearest == 0 || squared < nearest) nearest = squared;
  });
  return inside ? -nearest : nearest;
}

void expect_as_by_brute_force(const OccupancyMap& map,
                              const CellBox& box,
                              const DistanceFieldOptions& options) {
  const DistanceField field(map, options);
  ASSERT_EQ(field.box(), box);
  const double limit =
      options.max_distance > 0 ? options.max_distance : std::numeric_limits<double>::infinity();
  std::size_t wrong = 0;
  for_each_cell_of(box, [&](const CellKey& cell) {
    const int squared = by_brute_force(map, box, options.unknown, cell);
    double truth = squared == 0 ? limit : std::min(limit, 0.1 * std::sqrt(std::abs(squared)));
    if (is_obstacle(map, cell, options.unknown)) truth = -truth;
    const bool hidden =
        options.unknown == UnknownCells::kUnknown && map.state_of_cell(cell) == CellState::kUnknown;
    const double got = field.at(cell);
    if (hidden ? !std::isnan(got) : got != truth) ++wrong;
    const bool counted = !hidden && std::abs(truth) < limit;
    if (counted && field.squared_cells(cell) != squared) ++wrong;
  });
  EXPECT_EQ(wrong, 0U) << "of " << box.cells() << " cells";
}

TEST(DistanceField, IsThatOfBruteForceOnRandomMapsWithEveryPolicyAndLimit) {
  Random random(5);
  const std::array<CellShares, 6> kinds = {
      CellShares{0.3, 0.02}, {0.5, 0.5}, {0.05, 0.95}, {0.97, 0.3}, {0, 0}, {0, 1}};
  for (int round = 0; round < 12; ++round) {
    const CellKey low = near_centre(static_cast<int>(random.below(16)) - 20, -3, -9);
    const CellKey high = {low[0] + static_cast<int>(random.below(14)),
                          low[1] + static_cast<int>(random.below(14)),
                          low[2] + static_cast<int>(random.below(14))};
    const CellBox box{low, high};
    const CellShares shares = kinds[static_cast<std::size_t>(round) % kinds.size()];
    const OccupancyMap map = random_map(random, box, shares);
    for (const auto unknown :
         {UnknownCells::kFree, UnknownCells::kOccupied, UnknownCells::kUnknown}) {
      for (const double limit : {0.0, 0.1, 0.3}) {
        SCOPED_TRACE(testing::Message() << "round " << round << ", policy "
                                        << static_cast<int>(unknown) << ", limit " << limit);
        expect_as_by_brute_force(map, box, {.box = box, .unknown = unknown, .max_distance = limit});
      }
    }
  }
}

TEST(DistanceField, AroundOneOccupiedCellIsTheDistanceToIt) {
  OccupancyMap map({.resolution = 0.05});
  const CellKey middle = near_centre(3, -2, 1);
  set_cell(map, middle, kOccupiedValue);
  const CellBox box{near_centre(-40, -33, -20), near_centre(50, 31, 70)};
  const DistanceField field(map, {.box = box});
  std::size_t wrong = 0;
  for_each_cell_of(box, [&](const CellKey& cell) {
    const double truth = (centre_of(cell, 0.05) - centre_of(middle, 0.05)).norm();
    const double expected = cell == middle ? -0.05 : truth;
    if (std::abs(field.at(cell) - expected) > 1e-12) ++wrong;
  });
  EXPECT_EQ(wrong, 0U);
}

TEST(DistanceField, OnEitherSideOfAThickWallGrowsByACellPerCell) {
  OccupancyMap map({.resolution = 0.2});
  const CellBox wall{near_centre(0, -30, -30), near_centre(6, 30, 30)};
  for_each_cell_of(wall, [&](const CellKey& cell) { set_cell(map, cell, kOccupiedValue); });
  const CellBox box{near_centre(-10, -30, -30), near_centre(16, 30, 30)};
  const DistanceField field(map, {.box = box});
  for (int x = -10; x <= 16; ++x) {
    const int cells = x < 0 ? -x : x > 6 ? x - 6 : -std::min(x + 1, 7 - x);
    EXPECT_DOUBLE_EQ(field.at(near_centre(x, 4, -7)), 0.2 * cells) << x;
  }
}

TEST(DistanceField, BetweenCentresIsLinearBesideAWallWithAGradientOfOneAcrossIt) {
  OccupancyMap map({.resolution = 0.2});
  const CellBox wall{near_centre(0, -10, -10), near_centre(0, 10, 10)};
  for_each_cell_of(wall, [&](const CellKey& cell) { set_cell(map, cell, kOccupiedValue); });
  const CellBox box{near_centre(-9, -10, -10), near_centre(9, 10, 10)};
  const DistanceField field(map, {.box = box});
  for (const double x : {-1.5, -1.0, -0.33, 0.45, 1.37}) {
    const auto sample = field.sample({x, 0.31, -0.74});
    ASSERT_TRUE(sample.has_value());
    EXPECT_NEAR(sample->distance, std::abs(x - 0.1), 1e-12) << x;
    EXPECT_NEAR((sample->gradient - Eigen::Vector3d(x < 0 ? -1 : 1, 0, 0)).norm(), 0, 1e-12) << x;
  }
  EXPECT_FALSE(field.sample({2.1, 0, 0}).has_value()) << "outside of the box";
  EXPECT_FALSE(field.sample({std::nan(""), 0, 0}).has_value());
  EXPECT_TRUE(std::isnan(field.at(near_centre(10, 0, 0))));
}

TEST(DistanceField, HasAGradientThatItsDifferencesConfirm) {
  Random random(11);
  const CellBox box{near_centre(-9, -9, -9), near_centre(9, 9, 9)};
  const OccupancyMap map = random_map(random, box, {0, 0.01});
  const DistanceField field(map);
  for (int i = 0; i < 200; ++i) {
    // Within a cube of eight centres the field is smooth.
    Eigen::Vector3d x;
    for (Eigen::Index k = 0; k < 3; ++k) {
      x[k] = 0.1 * (std::floor(16 * random.uniform()) - 8 + 0.5 + 0.1 + 0.8 * random.uniform());
    }
    const auto here = field.sample(x);
    ASSERT_TRUE(here.has_value());
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = 1e-6 * Eigen::Vector3d::Unit(k);
      const double slope =
          (field.sample(x + step)->distance - field.sample(x - step)->distance) / 2e-6;
      EXPECT_NEAR(here->gradient[k], slope, 1e-6);
    }
  }
}

TEST(DistanceField, IsTheSameForOneAndTwoThreads) {
  Random random(3);
  const CellBox box{near_centre(-50, -20, -11), near_centre(60, 30, 20)};
  const OccupancyMap map = random_map(random, box, {0.2, 0.003});
  const DistanceField one(map, {.unknown = UnknownCells::kUnknown, .num_threads = 1});
  const DistanceField two(map, {.unknown = UnknownCells::kUnknown, .num_threads = 2});
  ASSERT_EQ(one.box(), two.box());
  std::size_t different = 0;
  for_each_cell_of(one.box(), [&](const CellKey& cell) {
    const double a = one.at(cell);
    if (!(a == two.at(cell)) && !(std::isnan(a) && std::isnan(two.at(cell)))) ++different;
  });
  EXPECT_EQ(different, 0U);
}

TEST(DistanceField, CoversTheKnownBoxWhereNoneIsGiven) {
  OccupancyMap map({.resolution = 0.1});
  set_cell(map, near_centre(-7, 3, 2), kFreeValue);
  set_cell(map, near_centre(12, 5, 9), kOccupiedValue);
  const CellBox known{near_centre(-7, 3, 2), near_centre(12, 5, 9)};
  EXPECT_EQ(DistanceField(map).box(), known);
}

std::string refusal(const OccupancyMap& map, const DistanceFieldOptions& options) {
  try {
    const DistanceField field(map, options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(DistanceField, RefusesWhatItCannotHoldInASentence) {
  OccupancyMap map({.resolution = 0.1});
  EXPECT_NE(refusal(map, {}).find("at least one known cell"), std::string::npos);
  const CellBox large{near_centre(-2000, -2000, -2000), near_centre(2000, 2000, 2000)};
  EXPECT_NE(refusal(map, {.box = large}).find("4001 x 4001 x 4001 cells need"), std::string::npos);
  const CellBox space{{0, 0, 0}, {kKeyLimit - 1, 0, 0}};
  EXPECT_NE(refusal(map, {.box = space}).find("46340 cells from corner to corner"),
            std::string::npos);
  const CellBox turned{near_centre(1, 0, 0), near_centre(0, 0, 0)};
  EXPECT_NE(refusal(map, {.box = turned}).find("not above"), std::string::npos);
  EXPECT_NE(refusal(map, {.max_distance = -1}).find("max_distance"), std::string::npos);
}

TEST(DistanceField, HoldsAcrossTheLongestBox) {
  OccupancyMap map({.resolution = 0.01});
  const int far = kLongestDiagonal - 2;
  set_cell(map, {0, 0, 0}, kOccupiedValue);
  const DistanceField field(map, {.box = CellBox{{0, 0, 0}, {far, 0, 0}}});
  EXPECT_EQ(field.squared_cells({far, 0, 0}), far * far);
  const DistanceField upright(map, {.box = CellBox{{0, 0, 0}, {0, 0, far}}});
  EXPECT_EQ(upright.squared_cells({0, 0, far}), far * far);
}

}  // namespace
}  // namespace facula
