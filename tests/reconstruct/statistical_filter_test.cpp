// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

namespace facula {
namespace {

PointCloud patch_with_strays(std::size_t strays) {
  Random random(8);
  PointCloud cloud;
  add_patch(cloud, {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, 2000, 0.001, random);
  for (std::size_t i = 0; i < strays; ++i) {
    cloud.points.emplace_back(
        float(random.uniform()), float(random.uniform()), float(2 + 3 * random.uniform()));
  }
  return cloud;
}

/// The definition (Rusu 2008): mean distance to k neighbours, kept up to mean + ratio * deviation.
std::vector<std::size_t> brute_force(const PointCloud& cloud, int k, double ratio) {
  std::vector<double> means;
  for (const Eigen::Vector3f& p : cloud.points) {
    std::vector<double> distances;
    for (const Eigen::Vector3f& q : cloud.points) distances.push_back((p - q).norm());
    std::nth_element(distances.begin(), distances.begin() + k, distances.end());
    means.push_back(std::accumulate(distances.begin(), distances.begin() + k + 1, 0.0) / k);
  }
  const double n = double(means.size());
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / n;
  double squares = 0;
  for (const double m : means) squares += (m - mean) * (m - mean);
  const double limit = mean + ratio * std::sqrt(squares / (n - 1));
  std::vector<std::size_t> inliers;
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (means[i] <= limit) inliers.push_back(i);
  }
  return inliers;
}

TEST(StatisticalInliers, EqualsItsDefinitionByBruteForce) {
  const PointCloud cloud = patch_with_strays(40);
  EXPECT_EQ(statistical_inliers(cloud, {.neighbours = 12, .max_ratio = 1.5}),
            brute_force(cloud, 12, 1.5));
}

TEST(StatisticalInliers, DropsStraysAndKeepsTheSurface) {
  const auto inliers = statistical_inliers(patch_with_strays(40));
  ASSERT_FALSE(inliers.empty());
  EXPECT_LT(inliers.back(), 2000U);
  EXPECT_GT(inliers.size(), 1990U);
}

TEST(StatisticalInliers, KeepsAllWhenThereAreNoMorePointsThanNeighbours) {
  PointCloud cloud = sphere_points(10, 1);
  cloud.points[4].setConstant(NAN);
  EXPECT_EQ(statistical_inliers(cloud).size(), 9U);
  EXPECT_TRUE(statistical_inliers({}).empty());
}

TEST(StatisticalInliers, CountsIndicesInTheCallersCloudWhenPointsAreNotFinite) {
  PointCloud cloud = patch_with_strays(40);
  cloud.points.insert(cloud.points.begin(), Eigen::Vector3f::Constant(NAN));
  for (const std::size_t i : statistical_inliers(cloud)) {
    EXPECT_NEAR(cloud.points[i].z(), 1.0, 0.01);
  }
}

TEST(StatisticalInliers, RefusesOptionsOutOfRange) {
  EXPECT_NE(error_of([] { statistical_inliers({}, {.neighbours = 0}); }), "");
  EXPECT_NE(error_of([] { statistical_inliers({}, {.max_ratio = 0}); }), "");
}

}  // namespace
}  // namespace facula
