// SPDX-License-Identifier: GPL-3.0-or-later
// Registration of range scans of the Stanford bunny against their published poses.
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/register/icp.hpp>
#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

const PosedCloud& scan_named(const ScanProject& project, const std::string& name) {
  for (const PosedCloud& scan : project.scans) {
    if (scan.name == name) return scan;
  }
  ADD_FAILURE() << "no scan " << name;
  return project.scans.front();
}

RigidTransform off_by(double angle, double shift) {
  return exp_se3(
      (Eigen::Matrix<double, 6, 1>() << shift, shift, shift, angle, angle, angle).finished());
}

/// Registers `moved` to `fixed` from 5 degrees about and 5 mm along every axis off the published
/// pose, and compares the outcome with that pose, which is itself good to some 0.1 mm.
void expect_published_pose(const ScanProject& project,
                           const std::string& fixed,
                           const std::string& moved) {
  PointCloud target = scan_named(project, fixed).cloud;
  PointCloud source = scan_named(project, moved).cloud;
  estimate_normals(target);
  estimate_normals(source);
  const RigidTransform published = scan_named(project, fixed).world_from_scan.inverse() *
                                   scan_named(project, moved).world_from_scan;
  for (const double sign : {1.0, -1.0}) {
    const IcpResult result = register_icp(source,
                                          target,
                                          off_by(sign * 5 * kDegree, sign * 0.005) * published,
                                          {.max_distance = 0.02, .min_max_distance = 0.001});
    EXPECT_TRUE(result.converged);
    EXPECT_LT(result.rms, 0.25e-3);
    EXPECT_TRUE(is_near_pose(result.target_from_source, published, 0.12 * kDegree, 0.0003))
        << moved << " to " << fixed;
  }
}

TEST(BunnyRegistration, ReturnsToThePublishedPosesFromFiveDegreesAndFiveMillimetresOff) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  const ScanProject project = read_scan_project(folder / "data" / "bun.conf");
  expect_published_pose(project, "bun000", "bun045");
  expect_published_pose(project, "bun000", "bun315");
  expect_published_pose(project, "bun045", "bun090");
  expect_published_pose(project, "bun270", "bun315");
}

// A pair on which PCL's point-to-plane ICP was reported to fail (its issue 2403).
TEST(BunnyRegistration, HoldsScansTurnedByNinetyDegreesTogether) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  expect_published_pose(read_scan_project(folder / "data" / "bun.conf"), "bun045", "bun315");
}

}  // namespace
}  // namespace facula
