// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

std::vector<Eigen::Vector3f> random_points(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(float(random.uniform()), float(random.uniform()), float(random.normal()));
  }
  return points;
}

std::vector<float> sorted_distances(const std::vector<Eigen::Vector3f>& points,
                                    const Eigen::Vector3f& query) {
  std::vector<float> distances;
  for (const Eigen::Vector3f& p : points) distances.push_back((p - query).squaredNorm());
  std::sort(distances.begin(), distances.end());
  return distances;
}

TEST(NearestNeighbours, FindsWhatBruteForceFinds) {
  const auto points = random_points(3000, 1);
  const NearestNeighbours tree(points);
  for (const Eigen::Vector3f& query : random_points(200, 2)) {
    const auto expected = sorted_distances(points, query);
    const auto found = tree.nearest(query, 17);
    ASSERT_EQ(found.size(), 17U);
    for (std::size_t k = 0; k < found.size(); ++k) {
      EXPECT_NEAR(found[k].squared_distance, expected[k], 1e-6F * (1 + expected[k]));
      EXPECT_NEAR((points[found[k].index] - query).squaredNorm(), found[k].squared_distance, 1e-6F);
    }
    EXPECT_EQ(tree.nearest(query).index, found.front().index);
  }
}

TEST(NearestNeighbours, NamesEveryPointOnceWhenAskedForMoreThanThereAre) {
  const auto points = random_points(9, 3);
  const auto found = NearestNeighbours(points).nearest(Eigen::Vector3f::Zero(), 50);
  std::vector<std::size_t> indices;
  for (const auto& neighbour : found) indices.push_back(neighbour.index);
  std::sort(indices.begin(), indices.end());
  EXPECT_EQ(indices, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

TEST(NearestNeighbours, PassesOverPointsThatAreNotFiniteAndKeepsTheCallersIndices) {
  std::vector<Eigen::Vector3f> points = random_points(50, 4);
  points[3].setConstant(NAN);
  points[10].x() = INFINITY;
  const NearestNeighbours tree(points);
  EXPECT_EQ(tree.nearest(points[20]).index, 20U);
  EXPECT_EQ(tree.nearest(points[20], 100).size(), 48U);
  EXPECT_TRUE(tree.nearest(points[3], 5).empty());
}

TEST(NearestNeighbours, BearsManyEqualPoints) {
  const std::vector<Eigen::Vector3f> points(5000, Eigen::Vector3f(1, 2, 3));
  const NearestNeighbours tree(points);
  EXPECT_EQ(tree.nearest(Eigen::Vector3f(1, 2, 3), 10).size(), 10U);
}

TEST(NearestNeighbours, HasNothingToGiveWithoutPoints) {
  const NearestNeighbours tree({});
  EXPECT_TRUE(tree.nearest(Eigen::Vector3f::Zero(), 3).empty());
  EXPECT_NE(error_of([&] { tree.nearest(Eigen::Vector3f::Zero()); }), "");
}

}  // namespace
}  // namespace facula
