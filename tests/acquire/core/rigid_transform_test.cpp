// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <numbers>

namespace facula {
namespace {

using Twist = Eigen::Matrix<double, 6, 1>;
constexpr double kPi = std::numbers::pi;

Eigen::Vector3d random_direction(Random& random) {
  return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

RigidTransform random_pose(Random& random) {
  Twist twist;
  twist << 3 * random_direction(random), random_direction(random) * random.uniform() * 3;
  return exp_se3(twist);
}

TEST(RigidTransform, ComposesAsItsMatricesDo) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform a = random_pose(random);
    const RigidTransform b = random_pose(random);
    EXPECT_LT(((a * b).matrix() - a.matrix() * b.matrix()).norm(), 1e-13);
  }
}

TEST(RigidTransform, InverseUndoesThePoseOnBothSides) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const RigidTransform a = random_pose(random);
    EXPECT_TRUE(is_near_pose(a * a.inverse(), RigidTransform(), 1e-14, 1e-13));
    EXPECT_TRUE(is_near_pose(a.inverse() * a, RigidTransform(), 1e-14, 1e-13));
  }
}

TEST(RigidTransform, ComposesAssociatively) {
  Random random(3);
  const RigidTransform a = random_pose(random);
  const RigidTransform b = random_pose(random);
  const RigidTransform c = random_pose(random);
  EXPECT_TRUE(is_near_pose((a * b) * c, a * (b * c), 1e-14, 1e-13));
}

TEST(RigidTransform, MovesPointsAsItsMatrixDoes) {
  Random random(4);
  const RigidTransform a = random_pose(random);
  const Eigen::Vector3d x(0.3, -2, 5);
  const Eigen::Vector3d expected = (a.matrix() * x.homogeneous()).head<3>();
  EXPECT_TRUE(is_near_point(a * x, expected, 1e-13));
}

TEST(RigidTransform, ExponentialOfAScrewAboutZIsTheClosedForm) {
  // Turning by w about z while moving by v along x gives the arc (v/w) (sin w, 1 - cos w, 0).
  const double w = 0.7;
  Twist twist;
  twist << 2, 0, 0.5, 0, 0, w;
  const RigidTransform pose = exp_se3(twist);
  EXPECT_TRUE(is_near_point(
      pose.translation, {2 / w * std::sin(w), 2 / w * (1 - std::cos(w)), 0.5}, 1e-14));
  EXPECT_NEAR(rotation_angle(pose), w, 1e-15);
  EXPECT_TRUE(is_near_point(
      pose.rotation * Eigen::Vector3d::UnitX(), {std::cos(w), std::sin(w), 0}, 1e-15));
}

TEST(RigidTransform, LogarithmUndoesTheExponentialAtEveryAngle) {
  Random random(5);
  for (const double angle : {0.0, 1e-14, 1e-9, 5e-7, 2e-6, 1e-4, 0.1, 1.0, 3.0, kPi - 1e-6}) {
    Twist twist;
    twist << 2 * random_direction(random), angle * random_direction(random);
    EXPECT_LT((log_se3(exp_se3(twist)) - twist).norm(), 1e-9) << "angle " << angle;
  }
}

TEST(RigidTransform, LogarithmAtHalfATurnGivesBackThePose) {
  // At exactly pi the axis has two directions; either must lead back to the same pose.
  Random random(6);
  for (int i = 0; i < 20; ++i) {
    Twist twist;
    twist << random_direction(random), kPi * random_direction(random);
    const RigidTransform pose = exp_se3(twist);
    const Twist back = log_se3(pose);
    EXPECT_NEAR(back.tail<3>().norm(), kPi, 1e-9);
    EXPECT_TRUE(is_near_pose(exp_se3(back), pose, 1e-7, 1e-7));
  }
}

TEST(RigidTransform, AngleIsTheShortWayRound) {
  Twist twist;
  twist << 0, 0, 0, 0, 1.5 * kPi, 0;
  EXPECT_NEAR(rotation_angle(exp_se3(twist)), 0.5 * kPi, 1e-14);
}

TEST(RigidTransform, ReadsBackItsMatrix) {
  Random random(7);
  const RigidTransform pose = random_pose(random);
  EXPECT_TRUE(is_near_pose(RigidTransform::from_matrix(pose.matrix()), pose, 1e-14, 0));
}

TEST(RigidTransform, ProjectsASlightlySkewedMatrixToARotation) {
  Eigen::Matrix3d skewed = Eigen::Matrix3d::Identity();
  skewed(0, 1) = 2e-4;
  const RigidTransform pose = RigidTransform::from_rotation(skewed);
  EXPECT_NEAR(pose.rotation.norm(), 1, 1e-15);
  // The nearest rotation shares the shear evenly: half of it is a turn about z.
  EXPECT_NEAR(rotation_angle(pose), 1e-4, 1e-8);
}

TEST(RigidTransform, RefusesMatricesThatAreNoPose) {
  Eigen::Matrix4d mirror = Eigen::Matrix4d::Identity();
  mirror(2, 2) = -1;
  EXPECT_THROW(RigidTransform::from_matrix(mirror), Error);
  Eigen::Matrix4d projective = Eigen::Matrix4d::Identity();
  projective(3, 0) = 0.1;
  EXPECT_THROW(RigidTransform::from_matrix(projective), Error);
  EXPECT_THROW(RigidTransform::from_rotation(2 * Eigen::Matrix3d::Identity()), Error);
  const Eigen::Matrix3d unknown = Eigen::Matrix3d::Constant(std::nan(""));
  EXPECT_THROW(RigidTransform::from_rotation(unknown), Error);
}

}  // namespace
}  // namespace facula
