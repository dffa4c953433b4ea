// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/map/log_odds_map.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <gtest/gtest.h>

namespace facula {
namespace {

const LogOddsModel kOctomap = {.hit = 0.8472978F, .miss = -0.4054651F, .min = -2, .max = 3.5F};

/// The same cells without tricks: one optional number each.
struct PlainBrick {
  std::array<std::optional<float>, kCellsPerBrick> cells;

  void apply(const CellMask& passed, const CellMask& ended, const LogOddsModel& model) {
    for (std::size_t cell = 0; cell < kCellsPerBrick; ++cell) {
      const float value = cells[cell].value_or(0);
      const auto clamped = [&](float x) { return std::clamp(x, model.min, model.max); };
      if (passed.test(cell)) cells[cell] = value <= model.min ? value : clamped(value + model.miss);
      if (ended.test(cell)) cells[cell] = value >= model.max ? value : clamped(value + model.hit);
    }
  }
};

CellMask random_mask(Random& random, double share) {
  CellMask mask;
  for (std::size_t cell = 0; cell < kCellsPerBrick; ++cell) {
    if (random.uniform() < share) mask.set(cell);
  }
  return mask;
}

void expect_equal(const LogOddsBrick& brick, const PlainBrick& plain, int seed) {
  for (std::size_t cell = 0; cell < kCellsPerBrick; ++cell) {
    ASSERT_EQ(brick.value(cell), plain.cells[cell]) << "seed " << seed << ", cell " << cell;
    ASSERT_EQ(brick.known().test(cell), plain.cells[cell].has_value());
    const bool occupied = plain.cells[cell].has_value() && *plain.cells[cell] >= 0;
    ASSERT_EQ(brick.occupied().test(cell), occupied);
  }
}

TEST(LogOddsBrick, HoldsWhatAPlainArrayHolds) {
  for (int seed = 0; seed < 60; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    LogOddsModel model = kOctomap;
    model.hit += 0.01F * static_cast<float>(seed % 3);  // from few values to many
    LogOddsBrick brick;
    PlainBrick plain;
    const double share = seed % 4 == 0 ? 1 : random.uniform();
    for (int scan = 0; scan < 12; ++scan) {
      CellMask ended = random_mask(random, seed % 2 == 0 ? 0.02 : 0.3);
      if (seed % 5 == 0) ended = {};
      const CellMask passed = random_mask(random, share) & ~ended;
      brick.apply(passed, ended, model);
      plain.apply(passed, ended, model);
      ASSERT_NO_FATAL_FAILURE(expect_equal(brick, plain, seed)) << "after scan " << scan;
    }
  }
}

TEST(LogOddsBrick, CostsNothingWhereAllCellsAgreeAndLittleWhereTheyNearlyDo) {
  LogOddsBrick brick;
  for (int scan = 0; scan < 10; ++scan) brick.apply(CellMask::all(), {}, kOctomap);
  EXPECT_EQ(brick.memory_usage(), 0U);
  EXPECT_EQ(brick.value(77), -2.0F);
  CellMask one;
  one.set(77);
  brick.apply({}, one, kOctomap);
  EXPECT_LE(brick.memory_usage(), 72U);
  EXPECT_EQ(brick.value(77), -2.0F + kOctomap.hit);
  EXPECT_EQ(brick.value(78), -2.0F);
}

TEST(LogOddsBrick, LeavesValuesBeyondTheBoundsAlone) {
  // A file may hold values that the present bounds do not allow; OctoMap does not touch them.
  LogOddsBrick brick;
  brick.fill(5);
  brick.apply({}, CellMask::all(), kOctomap);
  EXPECT_EQ(brick.value(0), 5.0F);
  brick.apply(CellMask::all(), {}, kOctomap);
  EXPECT_EQ(brick.value(0), 3.5F);
}

TEST(LogOddsBrick, AssignsAndReadsBackAnyNumberOfValues) {
  Random random(3);
  for (const int different : {1, 2, 15, 16, 17, 400}) {
    LogOddsBrick::Values values;
    for (float& value : values) {
      value = static_cast<float>(random.below(static_cast<std::uint64_t>(different)));
    }
    const CellMask known = random_mask(random, 0.7);
    LogOddsBrick brick;
    brick.assign(values, known);
    LogOddsBrick::Values back{};
    EXPECT_TRUE(brick.read(back) == known);
    for_each_cell(known, [&](std::size_t cell) { EXPECT_EQ(back[cell], values[cell]); });
  }
}

TEST(BrickIndex, FindsWhatAStandardMapFindsAfterManyErasures) {
  Random random(8);
  BrickIndex index;
  std::map<std::uint64_t, std::size_t> plain;
  for (int step = 0; step < 20000; ++step) {
    const std::uint64_t code = random.below(700) << (3 * random.below(12));
    if (random.below(3) == 0 && plain.contains(code)) {
      index.erase(code);
      plain.erase(code);
    } else {
      bool added = false;
      const std::size_t place = index.find_or_add(code, static_cast<std::size_t>(step), &added);
      EXPECT_EQ(added, plain.emplace(code, static_cast<std::size_t>(step)).second);
      EXPECT_EQ(place, plain.at(code));
    }
  }
  EXPECT_EQ(index.size(), plain.size());
  for (const auto& [code, place] : plain) ASSERT_EQ(index.find(code), place);
  EXPECT_EQ(index.find(std::uint64_t{1} << 50), BrickIndex::kNone);
}

TEST(LogOddsMap, ForgetsErasedBricksOnly) {
  LogOddsMap map;
  for (std::uint64_t code = 0; code < 100; ++code) map.find_or_add(7 * code).fill(float(code));
  for (std::uint64_t code = 0; code < 100; code += 2) map.erase(7 * code);
  EXPECT_EQ(map.entries().size(), 50U);
  for (std::uint64_t code = 0; code < 100; ++code) {
    const LogOddsBrick* brick = map.find(7 * code);
    ASSERT_EQ(brick != nullptr, code % 2 == 1);
    if (brick != nullptr) {
      EXPECT_EQ(brick->value(0), static_cast<float>(code));
    }
  }
}

}  // namespace
}  // namespace facula
