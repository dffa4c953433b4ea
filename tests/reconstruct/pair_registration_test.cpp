// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/pair_registration.hpp>
#include <facula/tests/reconstruct/corner_scan.hpp>
#include <facula/tests/support/matchers.hpp>

#include <limits>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

RigidTransform known_pose() {
  return twist(0.4, -0.3, 0.2, 0.2, -0.5, 0.9);
}

/// Source points of a corner seen in another frame: target_from_source is `pose`.
PosedCloud seen_from(const PosedCloud& in_target, const RigidTransform& pose) {
  PosedCloud source = in_target;
  source.name = "moved";
  source.cloud = transformed(in_target.cloud, pose.inverse());
  return source;
}

/// Every method with every kernel.
class RegisterPair : public testing::TestWithParam<std::tuple<PairMethod, RobustKernel>> {
 protected:
  RegisterPair()
      : target_(build_pyramid(corner_scan(1, 4000, 0))),
        source_(build_pyramid(seen_from(corner_scan(2, 4000, 0), known_pose()))) {
    options_.method = std::get<0>(GetParam());
    options_.kernel = std::get<1>(GetParam());
    options_.max_distance = 0.5;
  }
  ScanPyramid target_;
  ScanPyramid source_;
  PairOptions options_;
};

TEST_P(RegisterPair, RecoversKnownPoseFromFarStart) {
  const RigidTransform start = twist(0.12, -0.1, 0.08, 0.12, -0.1, 0.14) * known_pose();
  const PairResult result = register_pair(source_, target_, start, options_);
  EXPECT_TRUE(result.converged);
  EXPECT_GT(result.overlap, 0.95);
  EXPECT_TRUE(result.undecided.empty());
  EXPECT_TRUE(is_near_pose(result.target_from_source, known_pose(), 0.05 * kDegree, 0.001));
}

TEST_P(RegisterPair, RecoversTheInverseWithTheScansExchanged) {
  const RigidTransform truth = known_pose().inverse();
  const RigidTransform start = twist(0.1, 0.1, -0.1, -0.1, 0.12, 0.1) * truth;
  const PairResult result = register_pair(target_, source_, start, options_);
  EXPECT_TRUE(result.converged);
  EXPECT_TRUE(is_near_pose(result.target_from_source, truth, 0.05 * kDegree, 0.001));
}

TEST_P(RegisterPair, DoesNotDependOnTheNumberOfThreads) {
  const RigidTransform start = twist(0.05, -0.05, 0.05, 0.05, -0.05, 0.05) * known_pose();
  PairResult result[2];
  for (const int threads : {1, 2}) {
    PosedCloud moved = seen_from(corner_scan(2, 4000, 0.001), known_pose());
    const ScanPyramid source = build_pyramid(moved, {.num_threads = threads});
    const ScanPyramid target = build_pyramid(corner_scan(1, 4000, 0.001), {.num_threads = threads});
    options_.num_threads = threads;
    result[threads - 1] = register_pair(source, target, start, options_);
  }
  EXPECT_EQ(result[0].target_from_source.matrix(), result[1].target_from_source.matrix());
  EXPECT_EQ(result[0].covariance, result[1].covariance);
  EXPECT_EQ(result[0].information, result[1].information);
  EXPECT_EQ(result[0].inlier_rms, result[1].inlier_rms);
  EXPECT_EQ(result[0].iterations, result[1].iterations);
}

INSTANTIATE_TEST_SUITE_P(MethodsAndKernels,
                         RegisterPair,
                         testing::Combine(testing::Values(PairMethod::kPointToPlane,
                                                          PairMethod::kGeneralized),
                                          testing::Values(RobustKernel::kNone,
                                                          RobustKernel::kHuber,
                                                          RobustKernel::kCauchy,
                                                          RobustKernel::kGemanMcClure,
                                                          RobustKernel::kTukey)));

TEST(RegisterPairRobustly, IsNotMisledByPointsThatOnlyTheSourceHas) {
  PosedCloud extra = corner_scan(3, 2000, 0);
  for (Eigen::Vector3f& p : extra.cloud.points) p += Eigen::Vector3f(0.1F, 0.15F, 2.0F);
  append(extra.cloud, corner_scan(2, 4000, 0).cloud);
  const ScanPyramid source = build_pyramid(seen_from(extra, known_pose()));
  const ScanPyramid target = build_pyramid(corner_scan(1, 4000, 0));
  const RigidTransform start = twist(0.05, -0.05, 0.05, 0.05, -0.05, 0.05) * known_pose();
  const PairResult result = register_pair(source, target, start);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(result.overlap, 0.8);
  EXPECT_TRUE(is_near_pose(result.target_from_source, known_pose(), 0.05 * kDegree, 0.001));
}

TEST(RegisterPairRobustly, TakesASigmaOfZeroForUnknown) {
  PosedCloud scan = seen_from(corner_scan(2, 4000, 0.001), known_pose());
  PosedCloud fixed = corner_scan(1, 4000, 0.001);
  const RigidTransform start = twist(0.05, -0.05, 0.05, 0.05, -0.05, 0.05) * known_pose();
  const PairResult none = register_pair(build_pyramid(scan), build_pyramid(fixed), start);
  EXPECT_TRUE(is_near_pose(none.target_from_source, known_pose(), 0.1 * kDegree, 0.002));
  // Scans that know nothing are as scans that do not say so.
  scan.cloud.sigma.assign(scan.cloud.size(), 0);
  fixed.cloud.sigma.assign(fixed.cloud.size(), 0);
  const PairResult zeros = register_pair(build_pyramid(scan), build_pyramid(fixed), start);
  EXPECT_EQ(zeros.target_from_source.matrix(), none.target_from_source.matrix());
  EXPECT_EQ(zeros.covariance, none.covariance);
  // Nor may a few such points outweigh all others.
  fixed.cloud.sigma.assign(fixed.cloud.size(), 0.001F);
  scan.cloud.sigma.assign(scan.cloud.size(), 0.001F);
  for (std::size_t i = 0; i < scan.cloud.size(); i += 7) {
    scan.cloud.sigma[i] = 0;
    scan.cloud.points[i] += Eigen::Vector3f(0.01F, 0.01F, 0.01F);
  }
  const PairResult some = register_pair(build_pyramid(scan), build_pyramid(fixed), start);
  EXPECT_TRUE(is_near_pose(some.target_from_source, known_pose(), 0.1 * kDegree, 0.002));
}

TEST(RegisterPairRobustly, TrustsAPointWithASmallSigmaMore) {
  // A board seen twice: exactly, and 10 mm too near with a sigma that admits it.
  PosedCloud scan = corner_scan(2, 4000, 0);
  scan.cloud.sigma.assign(scan.cloud.size(), 0.001F);
  PosedCloud doubtful = corner_scan(4, 4000, 0);
  for (Eigen::Vector3f& p : doubtful.cloud.points) p += Eigen::Vector3f(0.01F, 0.01F, 0.01F);
  doubtful.cloud.sigma.assign(doubtful.cloud.size(), 0.02F);
  append(scan.cloud, doubtful.cloud);
  PosedCloud fixed = corner_scan(1, 4000, 0);
  fixed.cloud.sigma.assign(fixed.cloud.size(), 0.001F);
  const ScanPyramid target = build_pyramid(fixed);
  const auto error_with = [&](const PosedCloud& source) {
    const PairResult result = register_pair(
        build_pyramid(source), target, RigidTransform{}, {.kernel = RobustKernel::kNone});
    return result.target_from_source.translation.norm();
  };
  const double weighted = error_with(scan);
  scan.cloud.sigma.clear();
  const double alike = error_with(scan);
  EXPECT_LT(weighted, 0.0003);
  EXPECT_GT(alike, 0.004);
}

TEST(RegisterPairCertainty, InformationIsTheInverseOfTheCovariance) {
  const ScanPyramid target = build_pyramid(corner_scan(1, 3000, 0.001));
  const ScanPyramid source = build_pyramid(corner_scan(2, 3000, 0.001));
  const PairResult result = register_pair(source, target, RigidTransform{});
  const Eigen::Matrix<double, 6, 6> product = result.information * result.covariance;
  EXPECT_LT((product - Eigen::Matrix<double, 6, 6>::Identity()).cwiseAbs().maxCoeff(), 1e-5);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(result.covariance);
  EXPECT_GT(solver.eigenvalues()(0), 0);
}

TEST(RegisterPairUndecided, LeavesThreeMotionsOfAPlaneAsTheGuessHasThem) {
  const ScanPyramid target = build_pyramid(patch_scan({{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, 1));
  const ScanPyramid source = build_pyramid(patch_scan({{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, 2));
  const RigidTransform guess = twist(0.05, -0.03, 0.04, 0.03, -0.02, 0.1);
  const PairResult result = register_pair(source, target, guess);
  ASSERT_EQ(result.undecided.size(), 3U);
  EXPECT_EQ(result.undecided[0].motion.substr(0, 12), "slides along");
  EXPECT_EQ(result.undecided[1].motion.substr(0, 12), "slides along");
  EXPECT_EQ(result.undecided[2].motion.substr(0, 11), "turns about");
  // What is decided (height and tilt) is found ...
  const Eigen::Vector3d up = result.target_from_source.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_LT(std::acos(std::min(1.0, up.z())), 0.05 * kDegree);
  EXPECT_LT(std::abs(result.target_from_source.translation.z()), 0.001);
  // ... the rest stays.
  EXPECT_NEAR(result.target_from_source.translation.x(), 0.05, 0.005);
  EXPECT_NEAR(result.target_from_source.translation.y(), -0.03, 0.005);
  const Eigen::Vector3d ahead = result.target_from_source.rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::atan2(ahead.y(), ahead.x()), 0.1, 0.01);
  EXPECT_TRUE(result.covariance.allFinite());
  EXPECT_TRUE(result.information.allFinite());
}

TEST(RegisterPairUndecided, NamesTheDirectionInWhichACorridorSlides) {
  // Floor, ceiling and two walls along (cos 10 deg, sin 10 deg, 0).
  const Eigen::Vector3d along(std::cos(10 * kDegree), std::sin(10 * kDegree), 0);
  const PairResult result = register_pair(build_pyramid(corridor_scan(2, along, 0.002)),
                                          build_pyramid(corridor_scan(1, along, 0.002)),
                                          twist(0.1, 0.04, 0.05, 0.02, -0.02, 0.03));
  ASSERT_EQ(result.undecided.size(), 1U);
  EXPECT_EQ(result.undecided[0].motion, "slides along (0.98, 0.17, 0)");
  EXPECT_TRUE(std::isinf(result.undecided[0].sigma));
  const Eigen::Vector3d moved = result.target_from_source * Eigen::Vector3d(0, 0, 0.2);
  const Eigen::Vector3d off = moved - Eigen::Vector3d(0, 0, 0.2);
  EXPECT_LT((off - off.dot(along) * along).norm(), 0.002);
  EXPECT_LT(rotation_angle(result.target_from_source), 0.1 * kDegree);
}

TEST(RegisterPairUndecided, ABallTurnsAboutItsCentre) {
  const ScanPyramid target = build_pyramid(ball_scan(3000, {1, 2, 3}, 0.5));
  const ScanPyramid source = build_pyramid(ball_scan(2500, {1.02, 1.99, 3.01}, 0.5));
  const PairResult result = register_pair(source, target, RigidTransform{});
  ASSERT_EQ(result.undecided.size(), 3U);
  for (const UndecidedDirection& direction : result.undecided) {
    EXPECT_EQ(direction.motion.substr(0, 11), "turns about") << direction.motion;
  }
  const Eigen::Vector3d centre = result.target_from_source * Eigen::Vector3d(1.02, 1.99, 3.01);
  EXPECT_TRUE(is_near_point(centre, {1, 2, 3}, 0.001));
}

TEST(RegisterPairRefuses, ScansThatDoNotMeetAndOptionsThatCannotBe) {
  const ScanPyramid target = build_pyramid(corner_scan(1, 2000, 0));
  const ScanPyramid source = build_pyramid(corner_scan(2, 2000, 0));
  const auto sentence = [&](const RigidTransform& guess, const PairOptions& options) {
    return error_of([&] { register_pair(source, target, guess, options); });
  };
  const std::string far = sentence(twist(100, 0, 0, 0, 0, 0), {});
  EXPECT_NE(far.find("'corner'"), std::string::npos) << far;
  EXPECT_NE(far.find("start nearer"), std::string::npos) << far;
  EXPECT_NE(sentence({}, {.max_distance = -1}).find("max_distance"), std::string::npos);
  EXPECT_NE(sentence({}, {.max_iterations = 0}).find("max_iterations"), std::string::npos);
  EXPECT_NE(sentence({}, {.coarsest_level = -1}).find("coarsest_level"), std::string::npos);
  RigidTransform lost;
  lost.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(sentence(lost, {}).find("not finite"), std::string::npos);
  EXPECT_NE(error_of([&] { register_pair({}, target, {}); }).find("build_pyramid"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
