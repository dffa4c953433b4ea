// SPDX-License-Identifier: GPL-3.0-or-later
// Registration without a guess on real scans, each turned at random first.
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/register/global_registration.hpp>
#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

/// The bunny's scans in frames of their own choice, ready for registration.
struct TurnedScans {
  std::vector<RigidTransform> world_from_scan;
  std::vector<ScanPyramid> pyramids;
  std::vector<GlobalFeatures> features;

  TurnedScans(const ScanProject& project,
              const std::vector<std::string>& names,
              std::uint64_t seed) {
    Random random(seed);
    for (const std::string& name : names) {
      for (const PosedCloud& scan : project.scans) {
        if (scan.name != name) continue;
        PosedCloud turned = scan;
        RigidTransform moved;
        moved.rotation =
            Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal());
        moved.rotation.normalize();
        moved.translation = 0.2 * Eigen::Vector3d(random.normal(), random.normal(), 1);
        turned.cloud = transformed(scan.cloud, moved);
        world_from_scan.push_back(scan.world_from_scan * moved.inverse());
        pyramids.push_back(build_pyramid(turned));
      }
    }
    std::vector<const ScanPyramid*> all;
    for (const ScanPyramid& pyramid : pyramids) all.push_back(&pyramid);
    const double voxel = feature_voxel(all);
    for (const ScanPyramid& pyramid : pyramids) {
      features.push_back(find_global_features(pyramid, {.voxel = voxel}));
    }
  }

  RigidTransform published(std::size_t target_from, std::size_t source) const {
    return world_from_scan[target_from].inverse() * world_from_scan[source];
  }
};

/// The published poses are themselves uncertain: bun270's by some 0.4 degrees and 0.5 mm.
bool is_published_pose(const TurnedScans& scans,
                       const GlobalResult& result,
                       std::size_t target,
                       std::size_t source,
                       double degrees,
                       double metres) {
  const RigidTransform published = scans.published(target, source);
  const RigidTransform& found = result.pair.target_from_source;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const auto& p : scans.features[source].cloud.points) middle += p.cast<double>();
  middle /= static_cast<double>(scans.features[source].cloud.size());
  return found.rotation.angularDistance(published.rotation) < degrees * kDegree &&
         (found * middle - published * middle).norm() < metres;
}

TEST(GlobalRegistrationBunny, AcceptsNeighboursFromAnyStartAtTheirPublishedPoses) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  const ScanProject project = read_scan_project(folder / "data" / "bun.conf");
  for (const std::uint64_t seed : {1, 2}) {
    const TurnedScans scans(
        project, {"bun000", "bun045", "bun090", "bun180", "bun270", "bun315"}, seed);
    const auto expect_accepted = [&](std::size_t target, std::size_t source, double slack) {
      const GlobalResult result =
          register_without_guess(scans.features[source], scans.features[target], {.seed = seed});
      EXPECT_EQ(result.verdict, Verdict::kAccepted) << result.reason;
      EXPECT_TRUE(is_published_pose(scans, result, target, source, 0.3 * slack, 0.0004 * slack))
          << scans.pyramids[source].name << " to " << scans.pyramids[target].name << ", seed "
          << seed;
    };
    expect_accepted(0, 1, 1);
    expect_accepted(1, 2, 1);
    expect_accepted(0, 5, 1);
    expect_accepted(5, 4, 1);
    expect_accepted(2, 3, 1);
    expect_accepted(3, 4, 2);
  }
}

TEST(GlobalRegistrationBunny, RefusesScansThatHardlyOverlapRatherThanInventAPose) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  const ScanProject project = read_scan_project(folder / "data" / "bun.conf");
  for (const std::uint64_t seed : {1, 2}) {
    const TurnedScans scans(project, {"bun000", "bun180", "bun090", "bun270"}, seed);
    for (const auto& [target, source] : {std::pair(0, 1), std::pair(2, 3)}) {
      const GlobalResult result =
          register_without_guess(scans.features[source], scans.features[target], {.seed = seed});
      EXPECT_EQ(result.verdict, Verdict::kRefused) << result.reason;
      EXPECT_FALSE(result.reason.empty());
    }
  }
}

TEST(GlobalRegistrationBunny, DoesWithoutSensorOrigins) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  ScanProject project = read_scan_project(folder / "data" / "bun.conf");
  for (PosedCloud& scan : project.scans) scan.cloud.sensor_origin.clear();
  const TurnedScans scans(project, {"bun000", "bun045", "bun180"}, 3);
  const GlobalResult found = register_without_guess(scans.features[1], scans.features[0]);
  EXPECT_EQ(found.verdict, Verdict::kAccepted) << found.reason;
  EXPECT_TRUE(is_published_pose(scans, found, 0, 1, 0.3, 0.0004));
  EXPECT_EQ(found.score.contradiction, 0) << "free space is not known without sensor origins";
  const GlobalResult none = register_without_guess(scans.features[2], scans.features[0]);
  EXPECT_EQ(none.verdict, Verdict::kRefused) << none.reason;
}

/// The alignment of the set's NOTE: a point-to-plane ICP reached from several starts.
TEST(GlobalRegistrationRoom, FindsTheAlignmentOfTheRoomScansOfPcl) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/pcl-data");
  const auto pyramid = [&](const char* file) {
    return build_pyramid(read_scan_project(folder / file).scans.front(), {.finest_voxel = 0.06});
  };
  const ScanPyramid target = pyramid("room_scan1.pcd");
  const ScanPyramid source = pyramid("room_scan2.pcd");
  Eigen::Matrix4d noted;
  noted << 0.75683, -0.65329, 0.02045, 1.96745, 0.65312, 0.75711, 0.01489, 0.05609, -0.02521,
      0.00209, 0.99968, 0.02871, 0, 0, 0, 1;
  for (const std::uint64_t seed : {1, 2}) {
    const GlobalResult result = register_without_guess(source, target, {.seed = seed});
    EXPECT_EQ(result.verdict, Verdict::kAccepted) << result.reason;
    EXPECT_TRUE(is_near_pose(
        result.pair.target_from_source, RigidTransform::from_matrix(noted), kDegree, 0.05));
  }
}

}  // namespace
}  // namespace facula
