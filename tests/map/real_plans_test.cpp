// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/map/path_plan.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// Places of the corridor of Freiburg's building 079, in either map's frame [m].
const Eigen::Vector3d kWestEnd(-5, -0.24, 0.6);
const Eigen::Vector3d kEastEnd079(24, 0.4, 0.6);
const Eigen::Vector3d kNorthEastRoom079(26.4, 3.4, 0.6);
const Eigen::Vector3d kEastEndGeb(23, -0.9, 0.6);
const Eigen::Vector3d kNorthEastRoomGeb(25.9, 4.2, 0.6);

/// Whether OctoMap's own tree has an obstacle nearer to x than radius.
bool blocked_in(const octomap::OcTree& tree,
                const Eigen::Vector3d& x,
                const PathPlanOptions& options) {
  const double cell = tree.getResolution();
  const auto reach = static_cast<int>(std::ceil(options.radius / cell)) + 1;
  const octomap::OcTreeKey own = tree.coordToKey(x.x(), x.y(), x.z());
  for (int dz = -reach; dz <= reach; ++dz) {
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const octomap::OcTreeKey key(static_cast<octomap::key_type>(own[0] + dx),
                                     static_cast<octomap::key_type>(own[1] + dy),
                                     static_cast<octomap::key_type>(own[2] + dz));
        const Eigen::Vector3d centre(
            tree.keyToCoord(key[0]), tree.keyToCoord(key[1]), tree.keyToCoord(key[2]));
        const Eigen::Vector3d gap = ((x - centre).cwiseAbs().array() - cell / 2).max(0).matrix();
        if (gap.norm() >= options.radius - 1e-9) continue;
        const octomap::OcTreeNode* node = tree.search(key);
        const bool unknown_blocks = options.unknown == UnknownCells::kOccupied;
        if (node == nullptr ? unknown_blocks : tree.isNodeOccupied(node)) return true;
      }
    }
  }
  return false;
}

void expect_way(const std::filesystem::path& path,
                const Eigen::Vector3d& to,
                const PathPlanOptions& options) {
  const OccupancyMap map = OccupancyMap::read(path);
  const PathPlan plan = plan_path(map, kWestEnd, to, options);
  const double straight = (to - kWestEnd).norm();
  EXPECT_GE(plan.length, straight - 1e-9);
  EXPECT_LT(plan.length, 1.5 * straight);
  EXPECT_GE(plan.least_clearance, options.radius);
  const auto tree = to_octomap(map);
  std::size_t blocked = 0;
  for (std::size_t i = 0; i < plan.samples.size(); ++i) {
    const PathSample& sample = plan.samples[i];
    if (blocked_in(*tree, sample.x, options)) ++blocked;
    EXPECT_TRUE(!options.flat || sample.x.z() == kWestEnd.z());
    const double gap = i == 0 ? 0 : (sample.x - plan.samples[i - 1].x).norm();
    EXPECT_LE(gap, map.resolution() / 2 + 1e-9);
  }
  EXPECT_EQ(blocked, 0U) << "of " << plan.samples.size() << " samples";
}

TEST(RealPlans, GoAlongTheCorridorOfFr079ThroughSpaceThatWasSeen) {
  FACULA_REQUIRE_REAL_DATA(path, "range/octomap-maps/fr_079.bt");
  expect_way(path, kEastEnd079, {.radius = 0.25});
  expect_way(path, kEastEnd079, {.radius = 0.25, .flat = true});
}

TEST(RealPlans, GoFromTheCorridorOfFr079IntoARoom) {
  FACULA_REQUIRE_REAL_DATA(path, "range/octomap-maps/fr_079.bt");
  expect_way(path, kNorthEastRoom079, {.radius = 0.25, .unknown = UnknownCells::kFree});
}

TEST(RealPlans, GoAlongTheCorridorOfGeb079ThroughSpaceThatWasSeen) {
  FACULA_REQUIRE_REAL_DATA(path, "range/octomap-maps/geb079.bt");
  expect_way(path, kEastEndGeb, {.radius = 0.25});
}

TEST(RealPlans, GoFromTheCorridorOfGeb079IntoARoom) {
  FACULA_REQUIRE_REAL_DATA(path, "range/octomap-maps/geb079.bt");
  expect_way(path, kNorthEastRoomGeb, {.radius = 0.25, .unknown = UnknownCells::kFree});
  expect_way(path, kEastEndGeb, {.radius = 0.25, .unknown = UnknownCells::kFree, .flat = true});
}

TEST(RealPlans, AreRefusedWhereTheMapHoldsNoWay) {
  FACULA_REQUIRE_REAL_DATA(path, "range/octomap-maps/geb079.bt");
  // A robot of 1.4 m across does not pass the furniture in the corridor.
  EXPECT_THROW(plan_path(OccupancyMap::read(path), kWestEnd, kEastEndGeb, {.radius = 0.7}), Error);
}

}  // namespace
}  // namespace facula
