// SPDX-License-Identifier: GPL-3.0-or-later
// The zero of a tilt axis, found from the squareness of rooms: simulated with a known error, and
// the scans of set range/os3ds-rotating-lidar, whose notes put it at -8 +- 2 degrees.
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/tilt_zero.hpp>
#include <facula/tests/reconstruct/corner_series.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

/// A corner of a room, scanned every degree with 3 mm of noise; the tilt written down is `wrong`
/// more than the tilt the beam had.
PanTiltList scanned_corner(double wrong) {
  PanTiltList list;
  Random random(51);
  for (int pan = -10; pan <= 100; ++pan) {
    for (int tilt = 15; tilt <= 155; ++tilt) {
      const double p = pan * kDegree;
      const double t = tilt * kDegree;
      const Eigen::Vector3d ray(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t));
      double range = 10;
      for (const Eigen::Vector4d& wall : {Eigen::Vector4d(1, 0, 0, 1.14),
                                          Eigen::Vector4d(0, 1, 0, 1.67),
                                          Eigen::Vector4d(0, 0, 1, 1.06),
                                          Eigen::Vector4d(0, 0, -1, 1.35)}) {
        const double cosine = wall.head<3>().dot(ray);
        if (cosine > 0) range = std::min(range, wall.w() / cosine);
      }
      list.range.push_back(range + 0.003 * random.normal());
      list.pan.push_back(p);
      list.tilt.push_back(t + wrong);
    }
  }
  return list;
}

TEST(TiltZero, IsFoundFromTheCornerOfARoom) {
  for (const double wrong : {8.0, -5.0}) {
    const TiltZero found = find_tilt_zero(scanned_corner(wrong * kDegree));
    EXPECT_NEAR(found.tilt_zero.value / kDegree, -wrong, 0.1);
    EXPECT_LT(found.tilt_zero.sigma, 0.2 * kDegree);
    EXPECT_LT(found.off_square, 0.1 * kDegree);
    EXPECT_GT(found.on_planes, 0.9);
  }
}

TEST(TiltZero, RefusesAScanThatDoesNotTellIt) {
  PanTiltList wall;  // a single one
  for (int i = 0; i < 6000; ++i) {
    wall.pan.push_back((i / 75 - 40) * kDegree);
    wall.tilt.push_back((i % 75 + 53) * kDegree);
    wall.range.push_back(1 / (std::sin(wall.tilt.back()) * std::cos(wall.pan.back())));
  }
  EXPECT_NE(error_of([&] { find_tilt_zero(wall); }).find("square"), std::string::npos);
  EXPECT_NE(error_of([&] { find_tilt_zero({}); }), "");
  EXPECT_NE(error_of([&] { find_tilt_zero(wall, {.largest = 2}); }), "");
  EXPECT_NE(error_of([&] { find_tilt_zero(wall, {.step = 0}); }), "");
}

TEST(TiltZeroRealData, IsMinusEightDegreesInTheScansOfTheCorner) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/os3ds-rotating-lidar");
  const TiltZeroSeries series = tilt_zero_series(folder);
  std::vector<double> zeros = series.zero.values;
  ASSERT_EQ(zeros.size(), 7U);
  for (const double zero : zeros) EXPECT_NEAR(zero, -8, 2.5);
  for (const double share : series.on_planes.values) EXPECT_GT(share, 0.55);
  std::sort(zeros.begin(), zeros.end());
  EXPECT_NEAR(zeros[3], -8, 1);  // the median
}

}  // namespace
}  // namespace facula
