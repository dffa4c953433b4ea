// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/triangulate/triangulate.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// Baseline 250 mm along x, laser sheet parallel to the optical axis: z = f s / x (source A, 1).
Rig parallel_rig() {
  Rig rig;
  rig.camera = {.width = 640, .height = 480, .fx = 600, .fy = 600, .cx = 320, .cy = 240};
  rig.lasers = {{.name = "red", .normal = Eigen::Vector3d::UnitX(), .distance = 0.25}};
  return rig;
}

TEST(Triangulate, FollowsTheRangeEquation) {
  for (const double x : {30.0, 75.0, 150.0, 300.0}) {
    const auto point = triangulate(parallel_rig(), 0, {320 + x, 240}, 0.1);
    ASSERT_TRUE(point.has_value());
    EXPECT_NEAR(point->x_in_camera.z(), 600 * 0.25 / x, 1e-9);
    EXPECT_NEAR(point->x_in_camera.x(), 0.25, 1e-12);
  }
}

/// dz = z^2 sigma / (f s) (source A, 5) on the optical axis, where the ray runs along z.
TEST(Triangulate, CarriesSigmaByTheDerivativeOfTheRangeEquation) {
  Rig rig = parallel_rig();
  rig.camera.cx = 100;  // a laser far off the axis would tilt the ray
  const double z = 3;
  const auto point = triangulate(rig, 0, {100 + 600 * 0.25 / z, 240}, 0.1);
  ASSERT_TRUE(point.has_value());
  EXPECT_NEAR(point->sigma, z * z * 0.1 / (600 * 0.25), 0.01 * point->sigma);
}

TEST(Triangulate, SigmaIsTheSpreadOfNoisyPixels) {
  Rig rig = parallel_rig();
  rig.camera.k1 = -0.1;
  const Eigen::Vector2d pixel(395, 300);
  const auto middle = triangulate(rig, 0, pixel, 0.2);
  ASSERT_TRUE(middle.has_value());
  Random random(3);
  double sum = 0;
  const int trials = 20000;
  for (int i = 0; i < trials; ++i) {
    const auto point = triangulate(rig, 0, {pixel.x() + 0.2 * random.normal(), pixel.y()}, 0.2);
    const double along =
        (point->x_in_camera - middle->x_in_camera).dot(middle->x_in_camera.normalized());
    sum += along * along;
  }
  EXPECT_NEAR(std::sqrt(sum / trials), middle->sigma, 0.03 * middle->sigma);
}

/// Published worked example of the Ciclop set: ray, plane normal, the point in camera and table.
TEST(Triangulate, AgreesWithThePublishedCiclopExample) {
  const Eigen::Vector3d ray(-0.08866434, -0.28534266, 1);
  LaserPlane plane;
  plane.normal = Eigen::Vector3d(-0.86952, -0.020884, 0.493456);
  plane.distance = 0.15611;  // n . Xc of the published point, 156.1100 mm; the plane's own distance
                             // is not printed
  const auto point = plane.intersect(ray);
  ASSERT_TRUE(point.has_value());
  EXPECT_TRUE(is_near_point(*point * 1000, {-24.00891, -77.26631, 270.78431}, 1e-4));

  Axis axis;
  Eigen::Matrix3d rc;
  rc << 0, 1, 0, 0, 0, -1, -1, 0, 0;
  RigidTransform camera_from_table = RigidTransform::from_rotation(rc);
  camera_from_table.translation = Eigen::Vector3d(-0.003, 0.022, 0.315);
  axis.scan_from_camera = camera_from_table.inverse();
  const Eigen::Vector3d published(-0.02400891, -0.07726631, 0.27078431);
  EXPECT_TRUE(is_near_point(
      axis.scan_from_camera_at(0) * published * 1000, {44.21569, -21.00891, 99.26632}, 1e-4));
}

TEST(Triangulate, GivesNothingBehindTheCameraOrAlongTheSheet) {
  EXPECT_FALSE(triangulate(parallel_rig(), 0, {200, 240}, 0.1).has_value());
  EXPECT_FALSE(triangulate(parallel_rig(), 0, {320, 240}, 0.1).has_value());
}

TEST(LaserPlane, RefusesAPlaneThroughTheCameraCentre) {
  LaserPlane plane;
  plane.distance = 0;
  EXPECT_NE(error_of([&] { plane.check(); }).find("camera centre"), std::string::npos);
}

}  // namespace
}  // namespace facula
