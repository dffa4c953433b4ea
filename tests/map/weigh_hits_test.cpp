// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/occupancy_map.hpp>
#include <facula/map/weigh_hits.hpp>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// Points at x = 1.05 m, one per row of cells of 100 mm.
PointCloud rays(const std::vector<float>& sigmas) {
  PointCloud cloud;
  for (std::size_t i = 0; i < sigmas.size(); ++i) {
    const float y = 0.05F + 0.1F * static_cast<float>(i);
    cloud.points.emplace_back(1.05F, y, 0.05F);
    cloud.sensor_origin.emplace_back(0.05F, y, 0.05F);
  }
  cloud.sigma = sigmas;
  return cloud;
}

TEST(WeighHits, CountsAPointByTheShareOfItsErrorWithinTheCell) {
  // 68.27 % of a normal distribution lie within one sigma: with half a cell that is 5.46 eighths.
  EXPECT_EQ(sure_eighths(0.05F, 0.1), 5);
  EXPECT_EQ(sure_eighths(0.001F, 0.1), 8);
  EXPECT_EQ(sure_eighths(10, 0.1), 1);
  EXPECT_EQ(sure_eighths(0, 0.1), 8);
  EXPECT_EQ(sure_eighths(std::numeric_limits<float>::quiet_NaN(), 0.1), 8);
}

TEST(WeighHits, GivesUnsurePointsSmallerHits) {
  OccupancyMap map({.resolution = 0.1, .weigh_sigma = true});
  map.insert(rays({0.001F, 0.05F, 10}));
  const auto expected = [](double eighths) {
    const double p = 0.5 + 0.2 * eighths / 8;
    return std::log(p / (1 - p));
  };
  EXPECT_NEAR(*map.log_odds({1.05, 0.05, 0.05}), expected(8), 1e-6);
  EXPECT_NEAR(*map.log_odds({1.05, 0.15, 0.05}), expected(5), 1e-6);
  EXPECT_NEAR(*map.log_odds({1.05, 0.25, 0.05}), expected(1), 1e-6);
  EXPECT_NEAR(*map.log_odds({0.55, 0.25, 0.05}), std::log(0.4 / 0.6), 1e-6);
}

TEST(WeighHits, TakesTheSurestPointOfACell) {
  PointCloud cloud = rays({10});
  append(cloud, rays({0.05F}));
  append(cloud, rays({10}));
  OccupancyMap map({.resolution = 0.1, .weigh_sigma = true});
  map.insert(cloud);
  const double p = 0.5 + 0.2 * 5 / 8;
  EXPECT_NEAR(*map.log_odds({1.05, 0.05, 0.05}), std::log(p / (1 - p)), 1e-6);
}

TEST(WeighHits, ChangesNothingUnlessAskedOrWithoutSigmas) {
  const CastOptions plain{.resolution = 0.1};
  const CastOptions weighed{.resolution = 0.1, .weigh_sigma = true};
  PointCloud cloud = rays({10, 10});
  EXPECT_FALSE(cells_of_scan(cloud, weighed).bricks == cells_of_scan(cloud, plain).bricks);
  cloud.sigma.clear();
  EXPECT_TRUE(cells_of_scan(cloud, weighed).bricks == cells_of_scan(cloud, plain).bricks);
}

}  // namespace
}  // namespace facula
