// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/rig/camera.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

Camera distorted_camera() {
  return {.width = 1152,
          .height = 768,
          .fx = 819.6,
          .fy = 820.9,
          .cx = 589.7,
          .cy = 355.8,
          .k1 = 0.098,
          .k2 = -0.182,
          .p1 = -0.0077,
          .p2 = 0.00015,
          .k3 = 0.01};
}

TEST(Camera, ProjectsAPinholeByProportion) {
  const Camera camera{.width = 640, .height = 480, .fx = 600, .fy = 500, .cx = 320, .cy = 240};
  EXPECT_TRUE(camera.project({0.5, -0.25, 2}).isApprox(Eigen::Vector2d(470, 177.5), 1e-12));
}

// Worked by hand from Brown's model at x = 0.5, y = -0.25: r2 = 0.3125.
TEST(Camera, DistortsByBrownsModel) {
  Camera camera = distorted_camera();
  const double r2 = 0.3125;
  const double radial = 1 + 0.098 * r2 - 0.182 * r2 * r2 + 0.01 * r2 * r2 * r2;
  const double x = 0.5 * radial + 2 * -0.0077 * 0.5 * -0.25 + 0.00015 * (r2 + 0.5);
  const double y = -0.25 * radial + -0.0077 * (r2 + 0.125) + 2 * 0.00015 * 0.5 * -0.25;
  EXPECT_TRUE(camera.distort({0.5, -0.25}).isApprox(Eigen::Vector2d(x, y), 1e-13));
}

TEST(Camera, UndistortsWhatItDistorts) {
  const Camera camera = distorted_camera();
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2d pixel(random.uniform() * 1151, random.uniform() * 767);
    const auto normalized = camera.undistort(pixel);
    ASSERT_TRUE(normalized.has_value());
    const Eigen::Vector2d again = camera.project({normalized->x(), normalized->y(), 1});
    EXPECT_LT((again - pixel).norm(), 1e-8) << pixel.transpose();
  }
}

TEST(Camera, RefusesToInvertAFoldedImage) {
  Camera camera{.width = 640, .height = 480, .fx = 300, .fy = 300, .cx = 320, .cy = 240};
  camera.k1 = -0.5;  // r (1 - r^2 / 2) turns back at r = 0.816, the corner lies at r = 1.33
  EXPECT_FALSE(camera.undistort({639, 479}).has_value());
  EXPECT_NE(error_of([&] { camera.check(); }).find("folds the image"), std::string::npos);
}

TEST(Camera, RefusesAbsurdValues) {
  const Camera good = distorted_camera();
  EXPECT_NO_THROW(good.check());
  Camera camera = good;
  camera.fx = 0;
  EXPECT_NE(error_of([&] { camera.check(); }).find("fx_px"), std::string::npos);
  camera = good;
  camera.cy = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(error_of([&] { camera.check(); }).find("cy_px"), std::string::npos);
  camera = good;
  camera.k2 = 1e9;
  EXPECT_NE(error_of([&] { camera.check(); }).find("distortion"), std::string::npos);
  camera = good;
  camera.width = 0;
  EXPECT_NE(error_of([&] { camera.check(); }).find("width_px"), std::string::npos);
}

}  // namespace
}  // namespace facula
