// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/filter/scan_filters.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr int kRows = 400;
constexpr int kCols = 30;

/// The ray of a cell: the camera stands off the axis and fans its rows out by 1 mrad.
Eigen::Vector3d ray(int row, int col) {
  const double pitch = 0.001 * (row - 0.5 * kRows);
  const double yaw = 0.01 * (col - 0.5 * kCols);
  return {std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch)};
}

const Eigen::Vector3d kEye(0.05, -0.02, 0.1);

/// Two frontal walls, x = 1 m below row `split` and x = 2 m above, seen with range noise.
PolarScan two_walls(double noise) {
  PolarScan scan = PolarScan::empty(kRows, kCols);
  Random random(3);
  for (int col = 0; col < kCols; ++col) {
    scan.sensor_origin[std::size_t(col)] = kEye;
    for (int row = 0; row < kRows; ++row) {
      const double x = row < kRows / 2 ? 1.0 : 2.0;
      const Eigen::Vector3d r = ray(row, col);
      const double t = (x - kEye.x()) / r.x() + noise * random.normal();
      scan.set(scan.index(row, col), kEye + t * r, 0.5F, 0.001F);
    }
  }
  return scan;
}

/// Puts mixed points at the given shares of the way between the walls, beside the edge.
std::set<std::size_t> add_mixed(PolarScan& scan, const std::vector<double>& shares) {
  std::set<std::size_t> mixed;
  for (int col = 0; col < kCols; ++col) {
    int row = kRows / 2;
    for (const double share : shares) {
      const std::size_t cell = scan.index(row, col);
      const Eigen::Vector3d r = ray(row, col);
      scan.set(cell, kEye + (1 + share - kEye.x()) / r.x() * r, 0.2F, 0.01F);
      mixed.insert(cell);
      ++row;
    }
  }
  return mixed;
}

TEST(RemoveMixedPoints, ClearsExactlyThePointsBetweenTwoWalls) {
  PolarScan scan = two_walls(0.0002);
  const auto mixed = add_mixed(scan, {0.2, 0.45, 0.8});
  EXPECT_EQ(remove_mixed_points(scan), mixed.size());
  for (std::size_t cell = 0; cell < scan.valid.size(); ++cell) {
    EXPECT_EQ(scan.valid[cell] == 0, mixed.count(cell) == 1) << "cell " << cell;
  }
}

TEST(RemoveMixedPoints, ClearsAMixedPointNearerToAWallThanAnEdgesJump) {
  PolarScan scan = two_walls(0.0002);
  const auto mixed = add_mixed(scan, {0.012, 0.6});
  EXPECT_EQ(remove_mixed_points(scan), mixed.size());
  for (const std::size_t cell : mixed) EXPECT_EQ(scan.valid[cell], 0);
}

TEST(RemoveMixedPoints, KeepsBothSidesOfACleanEdge) {
  PolarScan scan = two_walls(0.0002);
  EXPECT_EQ(remove_mixed_points(scan), 0U);
}

TEST(RemoveMixedPoints, ClearsAColumnOfMixedPointsAlongAnUprightEdge) {
  PolarScan scan = PolarScan::empty(50, kCols);
  std::set<std::size_t> mixed;
  for (int col = 0; col < kCols; ++col) {
    scan.sensor_origin[std::size_t(col)] = kEye;
    const double x = col < 15 ? 1.0 : col == 15 ? 1.4 : 2.0;
    for (int row = 0; row < 50; ++row) {
      const Eigen::Vector3d r = ray(row + 175, col);
      scan.set(scan.index(row, col), kEye + (x - kEye.x()) / r.x() * r, 0.5F, 0.001F);
      if (col == 15) mixed.insert(scan.index(row, col));
    }
  }
  EXPECT_EQ(remove_mixed_points(scan), mixed.size());
  for (const std::size_t cell : mixed) EXPECT_EQ(scan.valid[cell], 0);
}

TEST(RemoveMixedPoints, KeepsAThinRodBeforeAWall) {
  PolarScan scan = PolarScan::empty(50, kCols);
  for (int col = 0; col < kCols; ++col) {
    scan.sensor_origin[std::size_t(col)] = kEye;
    const double x = col == 12 ? 1.0 : 2.0;
    for (int row = 0; row < 50; ++row) {
      const Eigen::Vector3d r = ray(row + 175, col);
      scan.set(scan.index(row, col), kEye + (x - kEye.x()) / r.x() * r, 0.5F, 0.001F);
    }
  }
  EXPECT_EQ(remove_mixed_points(scan), 0U);
}

TEST(RemoveMixedPoints, KeepsASlantedWallBelowTheSteepestAngle) {
  // The wall's normal and the ray of the middle row differ by 1.3 rad, less than 1.4.
  PolarScan scan = PolarScan::empty(kRows, 3);
  const Eigen::Vector3d normal(std::cos(1.3), 0, std::sin(1.3));
  for (int col = 0; col < 3; ++col) {
    scan.sensor_origin[std::size_t(col)] = kEye;
    for (int row = 170; row < 230; ++row) {
      const Eigen::Vector3d r = ray(row, col);
      scan.set(scan.index(row, col), kEye + normal.x() / r.dot(normal) * r, 0.5F, 0.001F);
    }
  }
  EXPECT_EQ(remove_mixed_points(scan, {.min_jump = 0, .jump_ratio = 0}), 0U);
  EXPECT_GT(remove_mixed_points(scan, {.max_incidence = 1.2, .min_jump = 0, .jump_ratio = 0}),
            150U);
}

TEST(RemoveMixedPoints, ClearsAStripeThatLostPartOfItsLightPastAnUprightEdge) {
  // A wall at 1 m in front of one at 3 m; the stripe of the column beside the edge has lost half of
  // its light, seems 12 mm too far, and is twice as uncertain.
  PolarScan scan = PolarScan::empty(60, kCols);
  Random random(7);
  for (int col = 0; col < kCols; ++col) {
    scan.sensor_origin[std::size_t(col)] = kEye;
    for (int row = 0; row < 60; ++row) {
      const bool cut = col == 14;
      const double x = col < 15 ? 1.0 : 3.0;
      const float sigma = cut ? 0.003F : 0.0015F;
      const Eigen::Vector3d r = ray(row + 170, col);
      const double t = (x - kEye.x()) / r.x() + (cut ? 0.012 : 0) + sigma * random.normal();
      scan.set(scan.index(row, col), kEye + t * r, 0.5F, sigma);
    }
  }
  EXPECT_EQ(remove_mixed_points(scan, {.max_deviation = 0}), 0U);
  const std::size_t removed = remove_mixed_points(scan);
  EXPECT_GE(removed, 48U);
  EXPECT_LE(removed, 62U);
  std::size_t left = 0;
  for (int row = 0; row < 60; ++row) left += scan.valid[scan.index(row, 14)];
  EXPECT_LE(left, 12U);
}

TEST(RemoveMixedPoints, RefusesOptionsOutOfRange) {
  PolarScan scan = PolarScan::empty(2, 2);
  EXPECT_NE(error_of([&] { remove_mixed_points(scan, {.max_incidence = 1.6}); }), "");
  EXPECT_NE(error_of([&] { remove_mixed_points(scan, {.min_jump = -1}); }), "");
  EXPECT_NE(error_of([&] { remove_mixed_points(scan, {.min_run = 0}); }), "");
  EXPECT_NE(error_of([&] { remove_mixed_points(scan, {.max_deviation = -1}); }), "");
  EXPECT_EQ(remove_mixed_points(scan), 0U);
}

TEST(RemoveMixedPoints, AreNotSoughtBySigmasThatAreUnknown) {
  // Without noise every deviation would exceed four sigmas of nothing.
  PolarScan scan = two_walls(0);
  for (std::size_t cell = 0; cell < scan.sigma.size(); cell += 2) scan.sigma[cell] = 0;
  EXPECT_EQ(remove_mixed_points(scan), 0U);
  scan = two_walls(0.0002);
  scan.sigma.assign(scan.sigma.size(), 0);
  const auto mixed = add_mixed(scan, {0.2, 0.45, 0.8});
  EXPECT_EQ(remove_mixed_points(scan), mixed.size());
}

}  // namespace
}  // namespace facula
