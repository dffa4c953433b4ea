// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/register/icp.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>

#include <limits>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

/// Floor, two walls and a slanted board: holds all six directions. Seen from (1, 1, 1.2).
PointCloud corner(std::uint64_t seed, std::size_t points_per_patch, double sigma) {
  Random random(seed);
  PointCloud cloud;
  add_patch(cloud, {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, points_per_patch, sigma, random);
  add_patch(cloud, {{0, 0, 0}, {0, 2, 0}, {0, 0, 1.5}}, points_per_patch, sigma, random);
  add_patch(cloud, {{0, 0, 0}, {2, 0, 0}, {0, 0, 1.5}}, points_per_patch, sigma, random);
  add_patch(
      cloud, {{1, 0.2, 0}, {0.6, 0.3, 0}, {-0.2, 0.3, 0.5}}, points_per_patch / 4, sigma, random);
  cloud.sensor_origin.assign(cloud.size(), Eigen::Vector3f(1.2F, 1.2F, 1.2F));
  return cloud;
}

RigidTransform known_pose() {
  return exp_se3((Eigen::Matrix<double, 6, 1>() << 0.4, -0.3, 0.2, 0.2, -0.5, 0.9).finished());
}

RigidTransform twist(double tx, double ty, double tz, double rx, double ry, double rz) {
  return exp_se3((Eigen::Matrix<double, 6, 1>() << tx, ty, tz, rx, ry, rz).finished());
}

/// Source points of a corner seen in another frame: target_from_source is `pose`.
PointCloud seen_from(const PointCloud& in_target, const RigidTransform& pose) {
  PointCloud source = transformed(in_target, pose.inverse());
  estimate_normals(source);
  return source;
}

class RegisterIcp : public testing::Test {
 protected:
  RegisterIcp()
      : target_(corner(1, 4000, 0)), source_(seen_from(corner(2, 4000, 0), known_pose())) {
    estimate_normals(target_);
  }
  PointCloud target_;
  PointCloud source_;
};

TEST_F(RegisterIcp, RecoversKnownPoseFromFarStart) {
  const RigidTransform start = twist(0.12, -0.1, 0.08, 0.12, -0.1, 0.14) * known_pose();
  const IcpResult result = register_icp(source_, target_, start, {.max_distance = 0.5});
  EXPECT_TRUE(result.converged);
  EXPECT_GT(result.overlap, 0.95);
  EXPECT_TRUE(is_near_pose(result.target_from_source, known_pose(), 0.02 * kDegree, 0.0005));
}

TEST_F(RegisterIcp, RecoversTheInverseWithTheCloudsExchanged) {
  const RigidTransform truth = known_pose().inverse();
  const RigidTransform start = twist(0.1, 0.1, -0.1, -0.1, 0.12, 0.1) * truth;
  const IcpResult result = register_icp(target_, source_, start, {.max_distance = 0.5});
  EXPECT_TRUE(result.converged);
  EXPECT_TRUE(is_near_pose(result.target_from_source, truth, 0.02 * kDegree, 0.0005));
}

TEST_F(RegisterIcp, ReachesTheSamePoseFromSeveralStarts) {
  Random random(11);
  for (int start = 0; start < 8; ++start) {
    Eigen::Matrix<double, 6, 1> off;
    for (int i = 0; i < 6; ++i) off(i) = 0.12 * (2 * random.uniform() - 1);
    const auto result =
        register_icp(source_, target_, exp_se3(off) * known_pose(), {.max_distance = 0.5});
    EXPECT_TRUE(result.converged) << "start " << start;
    EXPECT_TRUE(is_near_pose(result.target_from_source, known_pose(), 0.02 * kDegree, 0.0005))
        << "start " << start;
  }
}

TEST_F(RegisterIcp, IsNotMisledByPointsThatOnlyTheSourceHas) {
  PointCloud extra = corner(3, 2000, 0);
  for (Eigen::Vector3f& p : extra.points) p += Eigen::Vector3f(0.1F, 0.15F, 2.0F);
  append(extra, corner(2, 4000, 0));
  const PointCloud source = seen_from(extra, known_pose());
  const RigidTransform start = twist(0.05, -0.05, 0.05, 0.05, -0.05, 0.05) * known_pose();
  const IcpResult result = register_icp(source, target_, start);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(result.overlap, 0.8);
  EXPECT_TRUE(is_near_pose(result.target_from_source, known_pose(), 0.05 * kDegree, 0.001));
}

TEST_F(RegisterIcp, DoesNotDependOnTheNumberOfThreads) {
  const RigidTransform start = twist(0.05, -0.05, 0.05, 0.05, -0.05, 0.05) * known_pose();
  const auto one = register_icp(source_, target_, start, {.num_threads = 1});
  const auto four = register_icp(source_, target_, start, {.num_threads = 4});
  EXPECT_EQ(one.target_from_source.matrix(), four.target_from_source.matrix());
  EXPECT_EQ(one.covariance, four.covariance);
  EXPECT_EQ(one.iterations, four.iterations);
}

TEST(RegisterIcpCovariance, IsHonestOverSeededTrials) {
  constexpr int kTrials = 100;
  constexpr double kSigma = 0.002;
  double chi2 = 0;
  double stated = 0;
  double found = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto seed = static_cast<std::uint64_t>(trial);
    PointCloud target = corner(1000 + seed, 700, kSigma);
    estimate_normals(target);
    const PointCloud source = seen_from(corner(5000 + seed, 700, kSigma), known_pose());
    const auto result =
        register_icp(source, target, twist(0.01, -0.01, 0.01, 0.01, 0.01, -0.01) * known_pose());
    const auto error = log_se3(known_pose() * result.target_from_source.inverse());
    chi2 += error.dot(result.covariance.ldlt().solve(error));
    stated += result.covariance.trace();
    found += error.squaredNorm();
  }
  RecordProperty("chi2", std::to_string(chi2));
  // Six degrees of freedom per trial: chi2 has mean 600 and standard deviation sqrt(2 * 600).
  EXPECT_NEAR(chi2, 6 * kTrials, 4 * std::sqrt(12.0 * kTrials))
      << "chi2 " << chi2 << ", stated rms error " << std::sqrt(stated / kTrials) << ", found "
      << std::sqrt(found / kTrials);
}

TEST_F(RegisterIcp, SaysWhyItRefuses) {
  const auto says = [&](const PointCloud& source, const PointCloud& target, const char* word) {
    const std::string sentence = error_of([&] { register_icp(source, target, RigidTransform{}); });
    EXPECT_NE(sentence.find(word), std::string::npos) << sentence;
  };
  says({}, target_, "source cloud is empty");
  says(source_, {}, "target cloud is empty");
  says(source_, corner(1, 50, 0), "normals");
  PointCloud far = source_;
  for (Eigen::Vector3f& p : far.points) p.x() += 100;
  says(far, target_, "source points have a target point");
  PointCloud lost = source_;
  for (Eigen::Vector3f& p : lost.points) p.setConstant(std::numeric_limits<float>::quiet_NaN());
  says(lost, target_, "source points have a target point");
  EXPECT_NE(error_of([&] {
              register_icp(source_, target_, RigidTransform{}, {.max_distance = 0});
            }).find("max_distance"),
            std::string::npos);
}

TEST(RegisterIcpDegenerate, RefusesASinglePlane) {
  Random random(2);
  PointCloud plane;
  add_patch(plane, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 2000, 0, random);
  plane.sensor_origin.assign(plane.size(), Eigen::Vector3f(0, 0, 3));
  estimate_normals(plane);
  const std::string sentence = error_of([&] { register_icp(plane, plane, RigidTransform{}); });
  EXPECT_NE(sentence.find("undecided"), std::string::npos) << sentence;
}

}  // namespace
}  // namespace facula
