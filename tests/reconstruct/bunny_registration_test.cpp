// SPDX-License-Identifier: GPL-3.0-or-later
// Registration of range scans of the Stanford bunny against their published poses.
#include <facula/reconstruct/register/pair_registration.hpp>
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

struct Bound {
  double degrees;
  double millimetres;
};

/// Registers `moved` to `fixed` from 5 degrees about and 5 mm along every axis off the published
/// pose, and compares the outcome with that pose, which is itself good to some 0.1 mm.
void expect_published_pose(const ScanProject& project,
                           const std::string& fixed,
                           const std::string& moved,
                           const Bound& bound) {
  const ScanPyramid target = build_pyramid(scan_named(project, fixed));
  const ScanPyramid source = build_pyramid(scan_named(project, moved));
  const RigidTransform published = scan_named(project, fixed).world_from_scan.inverse() *
                                   scan_named(project, moved).world_from_scan;
  for (const PairMethod method : {PairMethod::kGeneralized, PairMethod::kPointToPlane}) {
    for (const double sign : {1.0, -1.0}) {
      const PairResult result = register_pair(
          source, target, off_by(sign * 5 * kDegree, sign * 0.005) * published, {.method = method});
      EXPECT_TRUE(result.converged);
      EXPECT_TRUE(result.undecided.empty());
      EXPECT_LT(result.inlier_rms, 0.3e-3);
      EXPECT_TRUE(is_near_pose(
          result.target_from_source, published, bound.degrees * kDegree, bound.millimetres / 1000))
          << moved << " to " << fixed;
    }
  }
}

TEST(BunnyRegistration, ReturnsToThePublishedPosesFromFiveDegreesAndFiveMillimetresOff) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  const ScanProject project = read_scan_project(folder / "data" / "bun.conf");
  expect_published_pose(project, "bun000", "bun045", {0.06, 0.15});
  expect_published_pose(project, "bun000", "bun315", {0.06, 0.15});
  expect_published_pose(project, "bun045", "bun090", {0.12, 0.2});
  expect_published_pose(project, "bun270", "bun315", {0.12, 0.2});
}

// A pair on which PCL's point-to-plane ICP was reported to fail (its issue 2403).
TEST(BunnyRegistration, HoldsScansTurnedByNinetyDegreesTogether) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  expect_published_pose(
      read_scan_project(folder / "data" / "bun.conf"), "bun045", "bun315", {0.12, 0.2});
}

}  // namespace
}  // namespace facula
