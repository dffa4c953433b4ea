// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/map/map_query.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/tests/map/made_map.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

Eigen::Vector3d random_point(Random& random,
                             const Eigen::Vector3d& low,
                             const Eigen::Vector3d& high) {
  const Eigen::Vector3d part(random.uniform(), random.uniform(), random.uniform());
  return low + part.cwiseProduct(high - low);
}

/// A few dense bricks near the origin, or bricks so far apart that a table of all would be too
/// large.
OccupancyMap map_with(Random& random, bool far_apart) {
  OccupancyMap map = random_map(random,
                                {near_centre(-13, -9, -4), near_centre(12, 15, 11)},
                                {.unknown = 0.3, .occupied = 0.05});
  if (far_apart) set_cell(map, {60000, 100, 40000}, kOccupiedValue);
  return map;
}

TEST(MapQuery, FindsTheStatesOfTheMapWhetherItsBricksLieTogetherOrFarApart) {
  for (const bool far_apart : {false, true}) {
    Random random(8);
    const OccupancyMap map = map_with(random, far_apart);
    const MapQuery query(map);
    std::vector<Eigen::Vector3d> points = {{std::nan(""), 0, 0}, {1e9, 0, 0}};
    points.emplace_back(centre_of({60000, 100, 40000}, 0.1));
    for (int i = 0; i < 20000; ++i) {
      points.push_back(random_point(random, {-2, -2, -2}, {2, 2, 2}));
    }
    const std::vector<CellState> one = query.states(points, 1);
    EXPECT_EQ(one, query.states(points, 2));
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (one[i] != map.state(points[i])) ++wrong;
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_EQ(one[2], far_apart ? CellState::kOccupied : CellState::kUnknown);
  }
}

TEST(MapQuery, OfAnEmptyMapKnowsNothing) {
  const MapQuery query{OccupancyMap()};
  EXPECT_EQ(query.state({0, 0, 0}), CellState::kUnknown);
  EXPECT_FALSE(query.known().has_value());
  EXPECT_EQ(query.cast_ray({0, 0, 0}, {1, 0, 0}).end, RayHit::End::kUnknown);
  EXPECT_EQ(query.cast_ray({0, 0, 0}, {1, 0, 0}, {.unknown = UnknownCells::kFree}).end,
            RayHit::End::kNothing);
  EXPECT_FALSE(query.nearest_obstacle({0, 0, 0}, 1e6).has_value());
  const auto nearest = query.nearest_obstacle({0, 0, 0}, 1e6, UnknownCells::kOccupied);
  ASSERT_TRUE(nearest.has_value());
  EXPECT_EQ(nearest->distance, 0);
}

/// Whether both say the same about a ray: the same occupied cell, or none.
bool same_hit(const MapQuery& query,
              const octomap::OcTree& tree,
              const std::array<Eigen::Vector3f, 2>& ray,
              const RayQueryOptions& options) {
  octomap::point3d end;
  const bool passes = options.unknown == UnknownCells::kFree;
  const bool theirs =
      tree.castRay(to_octomap(ray[0]), to_octomap(ray[1]), end, passes, options.max_range);
  const RayHit ours = query.cast_ray(ray[0], ray[1], options);
  if (theirs != (ours.end == RayHit::End::kOccupied)) return false;
  if (!theirs) return true;
  const octomap::OcTreeKey key = tree.coordToKey(end);
  return ours.cell == CellKey{key[0], key[1], key[2]};
}

/// Rays from anywhere and from borders of cells, in any direction and along axes and diagonals.
std::array<Eigen::Vector3f, 2> random_ray(Random& random,
                                          const MapStatistics& statistics,
                                          double cell) {
  Eigen::Vector3d origin = random_point(random, statistics.min, statistics.max);
  Eigen::Vector3d direction(random.normal(), random.normal(), random.normal());
  if (random.below(3) == 0) origin = cell * (origin / cell).array().round().matrix();
  if (random.below(3) == 0) {
    for (Eigen::Index k = 0; k < 3; ++k) direction[k] = static_cast<double>(random.below(3)) - 1;
  }
  if (direction.isZero()) direction.x() = 1;
  return {origin.cast<float>(), direction.cast<float>()};
}

std::size_t different_hits(const OccupancyMap& map, int rays, Random& random) {
  const MapQuery query(map);
  const auto tree = to_octomap(map);
  const MapStatistics statistics = map.statistics();
  std::size_t different = 0;
  for (int i = 0; i < rays; ++i) {
    const auto ray = random_ray(random, statistics, map.resolution());
    for (const auto unknown : {UnknownCells::kFree, UnknownCells::kOccupied}) {
      for (const double range : {0.0, 0.7, 60.0}) {
        // OctoMap would walk to the end of space, and complain.
        if (range == 0 && unknown == UnknownCells::kFree) continue;
        if (!same_hit(query, *tree, ray, {.max_range = range, .unknown = unknown})) ++different;
      }
    }
  }
  return different;
}

TEST(MapQuery, CastsRaysToTheCellsThatOctoMapFinds) {
  Random random(21);
  for (int round = 0; round < 5; ++round) {
    OccupancyMap map = random_map(random,
                                  {near_centre(-13, -9, -14), near_centre(22, 15, 11)},
                                  {.unknown = 0.2 * round, .occupied = 0.02});
    EXPECT_EQ(different_hits(map, 1500, random), 0U) << "round " << round;
  }
}

TEST(MapQuery, CastsRaysInFr079ToTheCellsThatOctoMapFinds) {
  FACULA_REQUIRE_REAL_DATA(path, "range/octomap-maps/fr_079.bt");
  Random random(2);
  EXPECT_EQ(different_hits(OccupancyMap::read(path), 4000, random), 0U);
}

TEST(MapQuery, TellsWhereARayMeetsAWall) {
  OccupancyMap map({.resolution = 0.1});
  for_each_cell_of({near_centre(0, -20, -20), near_centre(30, 20, 20)}, [&](const CellKey& cell) {
    set_cell(map, cell, cell[0] == kCentreKey + 20 ? kOccupiedValue : kFreeValue);
  });
  const MapQuery query(map);
  const Eigen::Vector3f origin(0.55F, 0.03F, 0.02F);
  const RayHit hit = query.cast_ray(origin, {3, 1.5F, 0});
  ASSERT_EQ(hit.end, RayHit::End::kOccupied);
  EXPECT_NEAR(hit.point.x(), 2.0, 1e-6);
  EXPECT_NEAR(hit.point.y(), 0.03 + 1.45 / 2, 1e-6);
  EXPECT_NEAR(hit.distance, std::hypot(1.45, 1.45 / 2), 1e-6);
  EXPECT_EQ(hit.cell, near_centre(20, 7, 0));
  EXPECT_EQ(query.cast_ray(origin, {-1, 0, 0}).end, RayHit::End::kUnknown);
  EXPECT_NEAR(query.cast_ray(origin, {-1, 0, 0}).point.x(), 0, 1e-6);
  EXPECT_EQ(query.cast_ray(origin, {1, 0, 0}, {.max_range = 1}).end, RayHit::End::kNothing);
  const RayHit inside = query.cast_ray({2.05F, 0, 0}, {1, 0, 0});
  EXPECT_EQ(inside.end, RayHit::End::kOccupied);
  EXPECT_EQ(inside.distance, 0);
}

TEST(MapQuery, RefusesRaysWithoutDirectionOrPlace) {
  const MapQuery query{OccupancyMap()};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(query.cast_ray({0, 0, 0}, {0, 0, 0}), Error);
  EXPECT_THROW(query.cast_ray({0, 0, 0}, {nan, 0, 0}), Error);
  EXPECT_THROW(query.cast_ray({nan, 0, 0}, {1, 0, 0}), Error);
  EXPECT_THROW(query.cast_ray({1e9F, 0, 0}, {1, 0, 0}), Error);
  EXPECT_THROW(query.cast_ray({0, 0, 0}, {1, 0, 0}, {.max_range = -1}), Error);
  EXPECT_THROW(query.nearest_obstacle({0, 0, 0}, -1), Error);
  EXPECT_THROW(query.nearest_obstacle({std::nan(""), 0, 0}, 1), Error);
}

TEST(MapQuery, CountsTheCellsOfABoxAsOneByOne) {
  Random random(4);
  const OccupancyMap map = map_with(random, false);
  const MapQuery query(map);
  for (int round = 0; round < 60; ++round) {
    CellBox box{near_centre(-20, -20, -20), {}};
    for (std::size_t i = 0; i < 3; ++i) {
      box.low[i] += static_cast<int>(random.below(30));
      box.high[i] = box.low[i] + static_cast<int>(random.below(25));
    }
    CellCounts truth;
    for_each_cell_of(box, [&](const CellKey& cell) {
      const CellState state = map.state_of_cell(cell);
      ++(state == CellState::kFree       ? truth.free
         : state == CellState::kOccupied ? truth.occupied
                                         : truth.unknown);
    });
    const CellCounts counts = query.count(box);
    EXPECT_EQ(counts.free, truth.free);
    EXPECT_EQ(counts.occupied, truth.occupied);
    EXPECT_EQ(counts.unknown, truth.unknown);
    EXPECT_EQ(query.any_occupied(box), truth.occupied > 0);
  }
}

/// Distance from x to the nearest obstacle of a box, by looking at every cell; infinite without.
double nearest_by_brute_force(const OccupancyMap& map,
                              const CellBox& box,
                              const Eigen::Vector3d& x,
                              UnknownCells unknown) {
  double nearest = std::numeric_limits<double>::infinity();
  for_each_cell_of(box, [&](const CellKey& cell) {
    const CellState state = map.state_of_cell(cell);
    const bool blocks = state == CellState::kOccupied ||
                        (state == CellState::kUnknown && unknown == UnknownCells::kOccupied);
    if (!blocks) return;
    const Eigen::Vector3d away = (x - centre_of(cell, map.resolution())).cwiseAbs();
    const Eigen::Vector3d gap = (away.array() - map.resolution() / 2).max(0).matrix();
    nearest = std::min(nearest, gap.norm());
  });
  return nearest;
}

TEST(MapQuery, FindsTheNearestObstacleThatBruteForceFinds) {
  for (const bool far_apart : {false, true}) {
    Random random(14);
    const OccupancyMap map = map_with(random, far_apart);
    const MapQuery query(map);
    const CellBox around{near_centre(-40, -40, -40), near_centre(40, 40, 40)};
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3d x = random_point(random, {-2, -2, -2}, {2, 2, 2});
      const double radius = 1.9 * random.uniform();
      for (const auto unknown : {UnknownCells::kFree, UnknownCells::kOccupied}) {
        const double truth = nearest_by_brute_force(map, around, x, unknown);
        const auto found = query.nearest_obstacle(x, radius, unknown);
        ASSERT_EQ(found.has_value(), truth <= radius);
        if (!found) continue;
        EXPECT_NEAR(found->distance, truth, 1e-12);
        const CellState state = map.state_of_cell(found->cell);
        EXPECT_TRUE(state == CellState::kOccupied || unknown == UnknownCells::kOccupied);
      }
    }
  }
}

}  // namespace
}  // namespace facula
