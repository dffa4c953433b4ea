// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/polar_scan.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <numbers>
#include <set>

namespace facula {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(PolarScan, StoresThePolarFormOfAPoint) {
  PolarScan scan = PolarScan::empty(1, 1);
  for (const double yaw : {-3.0, -1.0, 0.0, 0.5, 2.5, kPi}) {
    for (const double pitch : {-1.5, -0.3, 0.0, 0.8, 1.5}) {
      const Eigen::Vector3d p = 2.5 * Eigen::Vector3d(std::cos(pitch) * std::cos(yaw),
                                                      std::cos(pitch) * std::sin(yaw),
                                                      std::sin(pitch));
      scan.set(0, p, 0.5F, 0.001F);
      EXPECT_NEAR(scan.range[0], 2.5, 1e-6);
      EXPECT_NEAR(scan.yaw[0], yaw, 1e-6);
      EXPECT_NEAR(scan.pitch[0], pitch, 1e-6);
      EXPECT_TRUE(is_near_point(scan.point[0].cast<double>(), p, 1e-6));
    }
  }
}

TEST(PolarScan, GivesStraightUpThePitchOfARightAngle) {
  PolarScan scan = PolarScan::empty(1, 1);
  scan.set(0, {0, 0, -4}, 0, 0);
  EXPECT_FLOAT_EQ(scan.pitch[0], static_cast<float>(-kPi / 2));
  scan.set(0, {0, 0, 0}, 0, 0);
  EXPECT_EQ(scan.range[0], 0);
  EXPECT_EQ(scan.pitch[0], 0);
}

TEST(PolarScan, CountsCellsColumnByColumn) {
  const PolarScan scan = PolarScan::empty(3, 4);
  std::set<std::size_t> cells;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 4; ++col) cells.insert(scan.index(row, col));
  }
  EXPECT_EQ(cells.size(), 12U);
  EXPECT_EQ(*cells.rbegin(), 11U);
  EXPECT_EQ(scan.index(1, 0) - scan.index(0, 0), 1U);
  EXPECT_EQ(scan.index(0, 1) - scan.index(0, 0), 3U);
}

TEST(PolarScan, StartsWithoutValidCellsAndClearsThem) {
  PolarScan scan = PolarScan::empty(2, 2);
  EXPECT_EQ(scan.valid_count(), 0U);
  EXPECT_TRUE(scan.point[3].array().isNaN().all());
  scan.set(3, {1, 2, 3}, 0.7F, 0.1F);
  EXPECT_EQ(scan.valid_count(), 1U);
  scan.clear(3);
  EXPECT_EQ(scan.valid_count(), 0U);
  EXPECT_TRUE(scan.point[3].array().isNaN().all());
  EXPECT_EQ(scan.range[3] + scan.yaw[3] + scan.pitch[3] + scan.intensity[3] + scan.sigma[3], 0);
}

TEST(PolarScan, CheckNamesTheArrayOfTheWrongLength) {
  PolarScan scan = PolarScan::empty(2, 3);
  EXPECT_NO_THROW(scan.check());
  scan.yaw.pop_back();
  EXPECT_NE(error_of([&] { scan.check(); }).find("'yaw' has 5"), std::string::npos);
  scan.yaw.push_back(0);
  scan.time.push_back(0);
  EXPECT_NE(error_of([&] { scan.check(); }).find("'time' has 4"), std::string::npos);
}

TEST(PolarScan, RefusesANegativeSize) {
  EXPECT_THROW(PolarScan::empty(-1, 3), Error);
}

}  // namespace
}  // namespace facula
