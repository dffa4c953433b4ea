// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/reconstruct/corner_series.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

TEST(CornerRealData, WallsStandAsTheNotesOfTheSetSay) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/os3ds-rotating-lidar");
  const CornerSeries corner = corner_series(folder, 0);
  EXPECT_NEAR(corner.ab.mean(), 90.10, 0.35);
  EXPECT_LT(corner.ab.spread(), 0.45);  // six of the notes' twelve scans
  // Within 2 of the notes' standard deviations of 2.3 and 2.1 degrees.
  EXPECT_NEAR(corner.ac.mean(), 92.77, 4.7);
  EXPECT_NEAR(corner.bc.mean(), 92.95, 4.2);
  EXPECT_NEAR(corner.a.mean(), 1136.4, 3.5);
  EXPECT_NEAR(corner.b.mean(), 1668.0, 3.9);
  EXPECT_NEAR(corner.c.mean(), 1058.3, 8.6);
}

TEST(CornerRealData, IsSquareOnceTheTiltIsPutRight) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/os3ds-rotating-lidar");
  const CornerSeries corner = corner_series(folder, -8 * kDegree);
  EXPECT_NEAR(corner.ab.mean(), 90.30, 0.35);
  EXPECT_LT(corner.ab.spread(), 0.45);
  EXPECT_NEAR(corner.ac.mean(), 89.66, 0.59);
  EXPECT_NEAR(corner.bc.mean(), 90.18, 0.53);
  EXPECT_NEAR(corner.a.mean(), 1136.3, 3.4);
  EXPECT_NEAR(corner.b.mean(), 1671.3, 5.2);
}

}  // namespace
}  // namespace facula
