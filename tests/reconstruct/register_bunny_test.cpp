// SPDX-License-Identifier: GPL-3.0-or-later
// All ten range scans of the Stanford bunny from nothing, against their published poses.
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

/// The motion that lays the found scans, as one body, onto the published ones.
RigidTransform published_from_found(const ScanProject& published, const ScanProject& found) {
  constexpr std::size_t kEvery = 100;
  Eigen::Matrix3Xd from(3, 0);
  Eigen::Matrix3Xd to(3, 0);
  for (std::size_t i = 0; i < found.scans.size(); ++i) {
    const auto& points = found.scans[i].cloud.points;
    for (std::size_t p = 0; p < points.size(); p += kEvery) {
      const Eigen::Vector3d x = points[p].cast<double>();
      from.conservativeResize(3, from.cols() + 1);
      to.conservativeResize(3, to.cols() + 1);
      from.rightCols<1>() = found.scans[i].world_from_scan * x;
      to.rightCols<1>() = published.scans[i].world_from_scan * x;
    }
  }
  return RigidTransform::from_matrix(Eigen::umeyama(from, to, false));
}

TEST(RegisterBunny, PlacesAllTenScansInShuffledOrderNearThePublishedPoses) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  const ScanProject given = read_scan_project(folder / "data" / "bun.conf");
  ScanProject published;
  Random random(4);
  for (std::size_t i = 0; i < given.scans.size(); ++i) {
    const auto place = static_cast<std::ptrdiff_t>(random.below(i + 1));
    published.scans.insert(published.scans.begin() + place, given.scans[i]);
  }
  ScanProject found = published;
  for (PosedCloud& scan : found.scans) scan.world_from_scan = {};
  const RegisterScansResult result = register_scans(found);
  EXPECT_EQ(result.placed, 10U);
  const RigidTransform back = published_from_found(published, found);
  for (std::size_t i = 0; i < found.scans.size(); ++i) {
    EXPECT_TRUE(result.scans[i].placed) << found.scans[i].name << ": " << result.scans[i].reason;
    EXPECT_TRUE(is_near_pose(back * found.scans[i].world_from_scan,
                             published.scans[i].world_from_scan,
                             0.3 * kDegree,
                             0.0004))
        << found.scans[i].name;
  }
}

}  // namespace
}  // namespace facula
