// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of registration without a guess, against closed forms and brute force.
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/register/feature_matches.hpp>
#include <facula/reconstruct/register/nearest_grid.hpp>
#include <facula/reconstruct/register/plane_triples.hpp>
#include <facula/reconstruct/register/scan_view.hpp>
#include <facula/tests/reconstruct/simulated_rooms.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

namespace facula {
namespace {

Eigen::Vector3f random_point(Random& random, double size) {
  return Eigen::Vector3d(size * random.uniform(), size * random.uniform(), size * random.uniform())
      .cast<float>();
}

TEST(NearestGrid, NamesAPointAsNearAsTheNearestToHalfACellsDiagonal) {
  Random random(1);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 300; ++i) points.push_back(random_point(random, 1));
  const double cell = 0.04;
  const double reach = 0.15;
  const NearestGrid grid(points, cell, reach);
  const double slack = std::sqrt(3.0) * cell;  // half a diagonal each way
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f x = random_point(random, 1.2);
    double best = INFINITY;
    for (const auto& p : points) best = std::min(best, double((p - x).norm()));
    const std::int32_t near = grid.near(x);
    if (near == NearestGrid::kNone) {
      EXPECT_GT(best, reach - slack);
      continue;
    }
    ++found;
    EXPECT_LE((points[static_cast<std::size_t>(near)] - x).norm(), best + slack);
  }
  EXPECT_GT(found, 1000);
}

TEST(NearestGrid, BearsNothingAndNonsense) {
  EXPECT_EQ(NearestGrid().near({0, 0, 0}), NearestGrid::kNone);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const NearestGrid grid({{nan, 0, 0}, {1e30F, 0, 0}, {0.5F, 0, 0}}, 0.1, 0.2);
  EXPECT_EQ(grid.near({0.5F, 0, 0}), 2);
  EXPECT_EQ(grid.near({nan, 0, 0}), NearestGrid::kNone);
  EXPECT_EQ(grid.near({-1e30F, 0, 0}), NearestGrid::kNone);
  EXPECT_THROW(NearestGrid({}, 0, 1), Error);
  EXPECT_THROW(NearestGrid({}, 0.1, 100), Error);
}

TEST(FeatureTree, FindsTheNearestFeaturesThatBruteForceFinds) {
  Random random(2);
  std::vector<FpfhFeature> features(400);
  for (auto& feature : features) {
    for (float& bin : feature) bin = static_cast<float>(random.uniform());
  }
  std::vector<std::uint32_t> keys(350);
  std::iota(keys.begin(), keys.end(), 50U);
  const FeatureTree tree(features, keys);
  const auto distance = [&](std::uint32_t a, std::uint32_t b) {
    double sum = 0;
    for (int k = 0; k < kFpfhBins; ++k) {
      const std::size_t bin = static_cast<std::size_t>(k);
      sum += std::pow(double(features[a][bin]) - double(features[b][bin]), 2);
    }
    return sum;
  };
  for (std::uint32_t query = 0; query < 50; ++query) {
    std::vector<std::uint32_t> expected = keys;
    std::sort(expected.begin(), expected.end(), [&](std::uint32_t a, std::uint32_t b) {
      return distance(query, a) < distance(query, b);
    });
    expected.resize(4);
    EXPECT_EQ(tree.nearest(features[query], 4), expected);
  }
  EXPECT_TRUE(FeatureTree(features, {}).nearest(features[0], 3).empty());
}

/// A plate of 1 m by 1 m at z = 0, seen from z = 2.
PointCloud plate(bool from_one_place) {
  PointCloud cloud;
  for (int i = 0; i <= 100; ++i) {
    for (int j = 0; j <= 100; ++j) {
      const Eigen::Vector3f p(float(i) / 100, float(j) / 100, 0);
      cloud.points.push_back(p);
      cloud.sensor_origin.push_back(from_one_place ? Eigen::Vector3f(0.5F, 0.5F, 2)
                                                   : Eigen::Vector3f(p + Eigen::Vector3f(0, 0, 2)));
    }
  }
  return cloud;
}

TEST(ScanView, KnowsTheSpaceInFrontOfAPlateAndNothingBehindIt) {
  for (const bool from_one_place : {false, true}) {
    const ScanView view(plate(from_one_place), 0.01);
    ASSERT_FALSE(view.empty());
    EXPECT_EQ(view.at({0.5, 0.4, 0.3}, 0.05), Seen::kFree);
    EXPECT_EQ(view.at({0.5, 0.4, 0.02}, 0.05), Seen::kSurface);
    EXPECT_EQ(view.at({0.5, 0.4, -0.3}, 0.05), Seen::kUnknown);
    EXPECT_EQ(view.at({1.5, 0.4, 0.3}, 0.05), Seen::kUnknown);
  }
  // Half way up, lines of sight to one place have left the space above the plate's rim.
  EXPECT_EQ(ScanView(plate(false), 0.01).at({0.95, 0.5, 1}, 0.05), Seen::kFree);
  EXPECT_EQ(ScanView(plate(true), 0.01).at({0.95, 0.5, 1}, 0.05), Seen::kUnknown);
}

/// A stage moves along y, and the fan of its sheet opens in x alone.
TEST(ScanView, FollowsAFanThatOpensInOneDirectionOnly) {
  PointCloud cloud = plate(false);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.sensor_origin[i] = Eigen::Vector3f(0.5F, cloud.points[i].y(), 2);
  }
  const ScanView view(cloud, 0.01);
  ASSERT_FALSE(view.empty());
  EXPECT_EQ(view.at({0.95, 0.5, 1}, 0.05), Seen::kUnknown);
  EXPECT_EQ(view.at({0.5, 0.95, 1}, 0.05), Seen::kFree);
}

TEST(ScanView, LooksAroundFromTheMiddleOfARoom) {
  const PosedCloud scan = scan_of_room({{{-2, -1.5, -1}, {2, 1.5, 1}}}, {.step = 0.02});
  const ScanView view(scan.cloud, 0.04);
  ASSERT_FALSE(view.empty());
  Random random(4);
  int free = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d inside(
        3.4 * random.uniform() - 1.7, 2.4 * random.uniform() - 1.2, 1.4 * random.uniform() - 0.7);
    if (view.at(inside, 0.05) == Seen::kFree) ++free;
    EXPECT_EQ(view.at(inside.normalized() * 4, 0.05), Seen::kUnknown);
  }
  EXPECT_GT(free, 430);  // all but those at the seams of the cube's sides
}

TEST(ScanView, IsSilentWithoutOrOnScatteredOrigins) {
  PointCloud cloud = sphere_points(500, 0.1);
  EXPECT_TRUE(ScanView(cloud, 0.01).empty());
  for (const auto& p : cloud.points) cloud.sensor_origin.emplace_back(5 * p);
  const ScanView view(cloud, 0.01);
  EXPECT_TRUE(view.empty());
  EXPECT_EQ(view.at({0, 0, 0}, 0.01), Seen::kUnknown);
}

TEST(RoomPlanes, FindsSixSidesOfABoxTurnedInwardsAndNoneOfABall) {
  const PosedCloud scan = scan_of_room({{{-2, -1.5, -1}, {2, 1.5, 1.4}}}, {.step = 0.02});
  const auto planes = room_planes(build_pyramid(scan), 1);
  ASSERT_EQ(planes.size(), 6U);
  std::multiset<double> distances;
  for (const Plane& plane : planes) {
    EXPECT_LT(plane.distance, 0) << "the normal points to the scanner, at the frame's origin";
    distances.insert(std::round(-100 * plane.distance) / 100);
  }
  EXPECT_EQ(distances, (std::multiset<double>{1, 1.4, 1.5, 1.5, 2, 2}));
  PosedCloud ball;
  ball.cloud = sphere_points(20000, 1);
  EXPECT_TRUE(room_planes(build_pyramid(ball), 1).empty());
}

}  // namespace
}  // namespace facula
