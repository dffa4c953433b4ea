// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>

#include <gtest/gtest.h>

namespace facula {
namespace {

using Neighbour = NearestNeighbours::Neighbour;

std::vector<Eigen::Vector3f> random_points(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3f> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(float(random.uniform()), float(random.uniform()), float(random.normal()));
  }
  return points;
}

/// Points in a lattice: most distances occur many times.
std::vector<Eigen::Vector3f> lattice(int side) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < side * side * side; ++i) {
    points.emplace_back(float(i % side), float(i / side % side), float(i / side / side));
  }
  return points;
}

/// All points by distance, equally near ones by index: what the header promises.
std::vector<Neighbour> brute_force(const std::vector<Eigen::Vector3f>& points,
                                   const Eigen::Vector3f& query) {
  std::vector<Neighbour> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f d = points[i] - query;
    if (d.allFinite()) all.push_back({i, (d.x() * d.x() + d.y() * d.y()) + d.z() * d.z()});
  }
  std::sort(all.begin(), all.end(), [](const Neighbour& a, const Neighbour& b) {
    return std::tie(a.squared_distance, a.index) < std::tie(b.squared_distance, b.index);
  });
  return all;
}

void expect_first(std::vector<Neighbour> expected, std::span<const Neighbour> found) {
  ASSERT_LE(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    ASSERT_EQ(found[k].index, expected[k].index) << k;
    ASSERT_EQ(found[k].squared_distance, expected[k].squared_distance) << k;
  }
}

/// Clouds of different kinds: scattered, on a surface, in a lattice, in a line, far away and tiny.
std::vector<std::vector<Eigen::Vector3f>> all_kinds() {
  std::vector<std::vector<Eigen::Vector3f>> kinds{random_points(3000, 1), lattice(13)};
  std::vector<Eigen::Vector3f> surface = random_points(5000, 2);
  for (auto& p : surface) p.z() = std::sin(5 * p.x());
  kinds.push_back(surface);
  std::vector<Eigen::Vector3f> line = random_points(700, 3);
  for (auto& p : line) p = Eigen::Vector3f(1, 2, 3) * p.x();
  kinds.push_back(line);
  std::vector<Eigen::Vector3f> far = random_points(900, 4);
  for (auto& p : far) p += Eigen::Vector3f(1e6F, -2e6F, 0);  // rounds to many equal points
  kinds.push_back(far);
  std::vector<Eigen::Vector3f> tiny = random_points(600, 5);
  for (auto& p : tiny) p *= 1e-22F;  // squares below the least float
  kinds.push_back(tiny);
  kinds.push_back(random_points(17, 6));
  kinds.push_back(random_points(1, 7));
  return kinds;
}

TEST(NearestNeighbours, AreThoseOfBruteForceToTheLastBitAndTie) {
  for (const auto& points : all_kinds()) {
    const NearestNeighbours tree(points);
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 50) {
      const Eigen::Vector3f query = 1.01F * points[i];
      const auto expected = brute_force(points, query);
      for (const int k : {1, 2, 17, 100}) {
        const auto found = tree.nearest(query, k);
        ASSERT_EQ(found.size(), std::min(points.size(), std::size_t(k)));
        expect_first(expected, found);
      }
      EXPECT_EQ(tree.nearest(query).index, expected.front().index);
    }
  }
}

TEST(NearestNeighbours, OfAllPointsAtOnceAreThoseOfBruteForce) {
  for (const auto& points : all_kinds()) {
    const NearestNeighbours tree(points);
    for (const int k : {1, 3, 20, 90}) {
      std::vector<std::vector<Neighbour>> found(points.size());
      tree.for_all_nearest(k, [&](std::size_t i, std::span<const Neighbour> near) {
        found[i].assign(near.begin(), near.end());
      });
      for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 60) {
        ASSERT_EQ(found[i].size(), std::min(points.size(), std::size_t(k)));
        std::sort(found[i].begin(), found[i].end(), [](const Neighbour& a, const Neighbour& b) {
          return std::tie(a.squared_distance, a.index) < std::tie(b.squared_distance, b.index);
        });
        expect_first(brute_force(points, points[i]), found[i]);
      }
    }
  }
}

TEST(NearestNeighbours, WithinARadiusAreThoseOfBruteForce) {
  for (const auto& points : all_kinds()) {
    const NearestNeighbours tree(points);
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 40) {
      const auto expected = brute_force(points, points[i]);
      const float radius = 1;  // in the lattice, some points lie exactly on the sphere
      const auto inside = std::count_if(expected.begin(), expected.end(), [](const Neighbour& n) {
        return n.squared_distance <= 1;
      });
      const auto found = tree.within(points[i], radius);
      ASSERT_EQ(found.size(), std::size_t(inside));
      expect_first(expected, found);
    }
    EXPECT_NE(error_of([&] { tree.within(points[0], -1); }), "");
    EXPECT_NE(error_of([&] { tree.within(points[0], NAN); }), "");
  }
}

TEST(NearestNeighbours, OfAllPointsAreTheSameForEveryNumberOfThreads) {
  const auto points = random_points(40000, 9);
  const auto sums = [&](int threads) {
    std::vector<float> sum(points.size());
    NearestNeighbours(points, threads)
        .for_all_nearest(
            11,
            [&](std::size_t i, std::span<const Neighbour> near) {
              for (const auto& n : near) sum[i] += std::sqrt(n.squared_distance);
            },
            threads);
    return sum;
  };
  EXPECT_EQ(sums(1), sums(3));
}

TEST(NearestNeighbours, FillsTheCallersBuffer) {
  const auto points = random_points(300, 8);
  const NearestNeighbours tree(points);
  std::array<Neighbour, 5> few;
  EXPECT_EQ(tree.nearest(points[7], few), 5U);
  expect_first(brute_force(points, points[7]), few);
  std::vector<Neighbour> many(400);
  EXPECT_EQ(tree.nearest(points[7], many), 300U);
  EXPECT_EQ(tree.nearest(Eigen::Vector3f::Constant(NAN), many), 0U);
  EXPECT_EQ(tree.nearest(points[7], std::span<Neighbour>()), 0U);
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
  EXPECT_TRUE(tree.within(Eigen::Vector3f::Zero(), 3).empty());
  tree.for_all_nearest(3, [](std::size_t, std::span<const Neighbour>) { FAIL(); });
  EXPECT_NE(error_of([&] { tree.nearest(Eigen::Vector3f::Zero()); }), "");
}

}  // namespace
}  // namespace facula
