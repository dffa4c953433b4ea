// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/convex_hull_3d.hpp>
#include <facula/reconstruct/measure/convex_hull_exact.hpp>
#include <facula/reconstruct/measure/convex_hull_filter.hpp>
#include <facula/reconstruct/measure/width.hpp>
#include <facula/tests/reconstruct/width_clouds.hpp>
#include <facula/tests/reconstruct/width_comparison.hpp>
#include <facula/tests/reconstruct/width_judge_cgal.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace facula {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points plate(std::size_t count, double thickness, unsigned seed) {
  Random random(seed);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    points.emplace_back(random.uniform(), 0.7 * random.uniform(), thickness * random.normal());
  }
  return points;
}

TEST(Width, EqualsTheExactJudgeOnCloudsOfAllKinds) {
  const WidthComparison found = compare_widths(150);
  EXPECT_LE(found.worst, 1e-12) << found.worst_kind;
  EXPECT_TRUE(found.flat_is_zero);
  EXPECT_GT(found.judged, 100U);
  EXPECT_GT(found.flat, 20U);
}

TEST(Width, EqualsTheExactJudgeWhereMostPointsAreFilteredOut) {
  const double unit = std::ldexp(1.0, -40);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Points points = plate(5000, seed == 3 ? 0.2 : 1e-4, seed);
    for (Eigen::Vector3d& p : points) {
      for (double& x : p) x = std::round(x / unit) * unit;
    }
    const double judged = judged_width(points, unit);
    EXPECT_NEAR(width_of(points).width, judged, 1e-12 * judged) << seed;
  }
}

TEST(Width, HasAllPointsBetweenItsPlanesAndTouchesThem) {
  for (unsigned seed = 0; seed < 120; ++seed) {
    const WidthCloud cloud = width_cloud(seed);
    const Width width = width_of(cloud.points);
    double size = 0;
    for (const Eigen::Vector3d& p : cloud.points) size = std::max(size, p.norm());
    EXPECT_NEAR(width.direction.norm(), 1, 1e-12);
    for (const Eigen::Vector3d& p : cloud.points) {
      EXPECT_GE(width.direction.dot(p), width.low - 1e-13 * size) << cloud.kind << " " << seed;
      EXPECT_LE(width.direction.dot(p), width.high + 1e-13 * size) << cloud.kind << " " << seed;
    }
    EXPECT_NEAR(width.high - width.low, width.width, 1e-13 * size);
    if (width.width == 0) continue;
    EXPECT_GE(width.low_points.size() + width.high_points.size(), 4U) << cloud.kind << " " << seed;
  }
}

TEST(Width, OfKnownBodiesIsWhatGeometrySays) {
  const Points tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  EXPECT_NEAR(width_of(tetrahedron).width, 2, 1e-15);  // between opposite edges; 4/sqrt(3) by faces
  Points box;
  for (int i = 0; i < 8; ++i) box.emplace_back(3 * (i & 1), 5 * ((i >> 1) & 1), 7 * (i >> 2));
  EXPECT_NEAR(width_of(box).width, 3, 1e-15);
  EXPECT_EQ(width_of(box).low_points.size(), 4U);
  EXPECT_EQ(width_of({{1, 2, 3}}).width, 0);
}

TEST(Width, IsTheSameForAnyNumberOfThreads) {
  const Points points = plate(30000, 1e-3, 5);
  const Width one = width_of(points, {.num_threads = 1});
  const Width two = width_of(points, {.num_threads = 2});
  EXPECT_EQ(one.width, two.width);
  EXPECT_EQ(one.direction, two.direction);
  EXPECT_EQ(one.low_points, two.low_points);
  EXPECT_EQ(one.high_points, two.high_points);
}

TEST(Width, RefusesWhatIsNoCloud) {
  EXPECT_THROW(width_of({}), Error);
  Points points = plate(10, 1, 1);
  points[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(width_of(points), Error);
  points = plate(5000, 1, 1);
  points[4000].z() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(width_of(points), Error);
}

TEST(HullFilter, KeepsEveryCornerOfTheHull) {
  for (const double thickness : {1e-15, 1e-8, 1e-4, 1.0}) {
    const Points points = plate(4000, thickness, 3);
    const std::vector<std::uint32_t> kept = hull_candidates(points);
    EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
    const std::set<std::uint32_t> candidates(kept.begin(), kept.end());
    for (const auto& face : convex_hull_3d(points).faces) {
      for (const std::uint32_t corner : face) EXPECT_TRUE(candidates.contains(corner)) << thickness;
    }
  }
  EXPECT_LT(hull_candidates(plate(100000, 1e-4, 4)).size(), 20000U);
}

TEST(ConvexHull, HasNoPointOutsideAndClosesUp) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    const WidthCloud cloud = width_cloud(seed);
    const Points& x = cloud.points;
    const ConvexHull hull = convex_hull_3d(x);
    if (hull.dimension < 3) continue;
    std::set<std::uint32_t> corners;
    for (std::size_t f = 0; f < hull.faces.size(); ++f) {
      const auto& [a, b, c] = hull.faces[f];
      corners.insert({a, b, c});
      for (const Eigen::Vector3d& p : x) {
        ASSERT_LE(side_of_plane(x[a], x[b], x[c], p), 0) << cloud.kind << " " << seed;
      }
      for (std::size_t e = 0; e < 3; ++e) {
        const auto& other = hull.faces[hull.neighbours[f][e]];
        const auto at = std::find(other.begin(), other.end(), hull.faces[f][(e + 1) % 3]);
        ASSERT_NE(at, other.end());
        EXPECT_EQ(other[(static_cast<std::size_t>(at - other.begin()) + 1) % 3], hull.faces[f][e]);
      }
    }
    EXPECT_EQ(hull.faces.size(), 2 * corners.size() - 4) << "Euler's formula, seed " << seed;
  }
}

TEST(SideOfPlane, SeesTheLastBit) {
  const Eigen::Vector3d a(0.1, 0.2, 0.3);
  const Eigen::Vector3d b(1.1, 0.7, 0.4);
  const Eigen::Vector3d c = 0.5 * (a + b) + Eigen::Vector3d(0, 0.3, 0);
  const Eigen::Vector3d d(0.35, 0.4, 0.325);
  EXPECT_EQ(side_of_plane({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1e-300}), 1);
  EXPECT_EQ(side_of_plane({0, 0, 0}, {3, 1, 2}, {1, 7, 5}, {4, 8, 7}), 0);
  // Turning the corners round changes nothing but the sign, whatever is rounded on the way.
  EXPECT_EQ(side_of_plane(a, b, c, d), side_of_plane(b, c, a, d));
  EXPECT_EQ(side_of_plane(a, b, c, d), -side_of_plane(b, a, c, d));
  EXPECT_EQ(side_of_plane(a, b, c, d), -side_of_plane(d, b, c, a));
  const double next = std::nextafter(7.0, 8.0);
  EXPECT_EQ(side_of_plane({0, 0, 0}, {3, 1, 2}, {1, 7, 5}, {4, 8, next}), 1);
}

}  // namespace
}  // namespace facula
