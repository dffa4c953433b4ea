// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/clearance.hpp>
#include <facula/map/path_plan.hpp>
#include <facula/tests/map/made_map.hpp>

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

const Eigen::Vector3d kStart(0.5, 0.5, 1);
const Eigen::Vector3d kGoal(3.5, 0.5, 1);

double clearance_in(const OccupancyMap& map, const Eigen::Vector3d& x, UnknownCells unknown) {
  double nearest = 10;
  for_each_cell_of({near_centre(-1, -1, -1), near_centre(40, 40, 20)}, [&](const CellKey& cell) {
    const CellState state = map.state_of_cell(cell);
    if (state == CellState::kFree) return;
    if (state == CellState::kUnknown && unknown != UnknownCells::kOccupied) return;
    const Eigen::Vector3d away = (x - centre_of(cell, map.resolution())).cwiseAbs();
    nearest = std::min(nearest, (away.array() - map.resolution() / 2).max(0).matrix().norm());
  });
  return nearest;
}

TEST(PathPlan, GoesThroughTheDoorAndKeepsItsRadiusAtEverySample) {
  const OccupancyMap map = hall_with_door();
  for (const auto unknown : {UnknownCells::kFree, UnknownCells::kOccupied}) {
    const PathPlan plan =
        plan_path(map, kStart, kGoal, {.radius = 0.25, .unknown = unknown, .max_clearance = 5});
    EXPECT_EQ(plan.corners.front(), kStart);
    EXPECT_EQ(plan.corners.back(), kGoal);
    EXPECT_GE(plan.least_clearance, 0.25);
    // The shortest way of a point goes straight to the door's near corners and back.
    const double corner = std::hypot(1.5, 2.5);
    EXPECT_GT(plan.length, 2 * corner + 0.1);
    EXPECT_LT(plan.length, 1.15 * (2 * std::hypot(1.5, 2.75) + 0.1));
    for (std::size_t i = 0; i < plan.samples.size(); ++i) {
      const PathSample& sample = plan.samples[i];
      const double gap = i > 0 ? (sample.x - plan.samples[i - 1].x).norm() : 0;
      EXPECT_LE(gap, 0.05 + 1e-9);
      if (i % 5 != 0) continue;
      EXPECT_NEAR(sample.clearance, clearance_in(map, sample.x, unknown), 1e-9);
    }
  }
}

TEST(PathPlan, KeepsItsRadiusBetweenSamplesToo) {
  const OccupancyMap map = hall_with_door();
  const PathPlan plan = plan_path(map, kStart, kGoal, {.radius = 0.3});
  const Clearance clearance(map, {});
  for (std::size_t i = 1; i < plan.corners.size(); ++i) {
    for (double t = 0; t <= 1; t += 0.002) {
      const Eigen::Vector3d x = plan.corners[i - 1] + t * (plan.corners[i] - plan.corners[i - 1]);
      EXPECT_GE(clearance.exact(x, 1), 0.3);
    }
  }
}

TEST(PathPlan, StaysAtItsHeightWhereItIsFlat) {
  const PathPlan plan = plan_path(hall_with_door(), kStart, kGoal, {.flat = true});
  for (const PathSample& sample : plan.samples) EXPECT_EQ(sample.x.z(), 1);
  EXPECT_GE(plan.least_clearance, 0.25);
}

TEST(PathPlan, IsTheSameForTheSameSeedAndAnyThreadsAndAnotherForAnotherSeed) {
  const OccupancyMap map = hall_with_door();
  const PathPlan one = plan_path(map, kStart, kGoal, {.seed = 7, .num_threads = 1});
  const PathPlan other = plan_path(map, kStart, kGoal, {.seed = 8, .num_threads = 1});
  const PathPlan two = plan_path(map, kStart, kGoal, {.seed = 7, .num_threads = 2});
  EXPECT_EQ(one.corners, two.corners);
  EXPECT_EQ(one.tries, two.tries);
  EXPECT_NE(one.corners, other.corners);
}

std::string refusal(const Eigen::Vector3d& from,
                    const Eigen::Vector3d& to,
                    const PathPlanOptions& options) {
  try {
    plan_path(hall_with_door(), from, to, options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(PathPlan, SaysWhatIsWrongWithAPlaceInASentence) {
  const auto says = [](const std::string& sentence, const std::string& part) {
    EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
  };
  says(refusal({2.05, 1, 1}, kGoal, {}), "expected the start in free space");
  says(refusal(kStart, {2.2, 1, 1}, {}), "expected the goal at least");
  says(refusal(kStart, {2.2, 1, 1}, {}), "has a clearance of 0.1 m");
  says(refusal(kStart, {9, 1, 1}, {}), "expected the goal within the map");
  says(refusal(kStart, {std::nan(""), 1, 1}, {}), "finite numbers");
  says(refusal(kStart, {3.5, 0.5, 0.7}, {.flat = true}), "same height");
  says(refusal({0.5, 0.5, 30}, {3.5, 0.5, 30}, {.flat = true}), "height within the map");
  says(refusal(kStart, kGoal, {.radius = 0.45}), "but there is none");
  // The door is 0.8 m wide: its cells may hold a ball of 0.42 m as far as the field can tell.
  says(refusal(kStart, kGoal, {.radius = 0.42, .max_tries = 300}), "none in 300 random tries");
  says(refusal(kStart, kGoal, {.radius = 0}), "radius above 0 m");
  says(refusal(kStart, kGoal, {.seed = 0}), "seed above 0");
}

TEST(PathPlan, OfAnEmptyMapSaysSo) {
  EXPECT_THROW(plan_path(OccupancyMap(), kStart, kGoal), Error);
}

TEST(Clearance, BoundsAndDecisionsAgreeWithTheMapsCells) {
  Random random(6);
  const OccupancyMap map = random_map(random,
                                      {near_centre(0, 0, 0), near_centre(39, 39, 19)},
                                      {.unknown = 0.001, .occupied = 0.003});
  for (const auto unknown : {UnknownCells::kFree, UnknownCells::kOccupied}) {
    for (const bool flat : {false, true}) {
      const auto height = flat ? std::optional<double>(0.83) : std::nullopt;
      const Clearance clearance(map, {.unknown = unknown, .height = height, .reach = 0.4});
      for (int i = 0; i < 60; ++i) {
        const Eigen::Vector3d x(
            4 * random.uniform(), 4 * random.uniform(), flat ? 0.83 : 2 * random.uniform());
        const double truth = clearance_in(map, x, unknown);
        EXPECT_NEAR(clearance.exact(x, 5), std::min(truth, 5.0), 1e-9);
        EXPECT_LE(clearance.at_least(x), truth);
        for (const double radius : {0.05, 0.2, 0.4}) {
          EXPECT_EQ(clearance.holds(x, radius), truth >= radius);
        }
      }
    }
  }
}

}  // namespace
}  // namespace facula
