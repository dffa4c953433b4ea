// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/deviation.hpp>

#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A tetrahedron with acute dihedral angles: at its edges and corners the nearest face alone tells
/// the side wrong.
TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5F, 0.9F, 0}, {0.5F, 0.3F, 3}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

/// Inside a convex mesh: behind all faces.
bool inside(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d x = mesh.vertices[a].cast<double>();
    const Eigen::Vector3d n = (mesh.vertices[b].cast<double>() - x)
                                  .cross(Eigen::Vector3d(mesh.vertices[c].cast<double>() - x));
    if (n.dot(p - x) > 0) return false;
  }
  return true;
}

/// A ball of rings x 2 rings quads, radius 1.
TriangleMesh ball(std::uint32_t rings) {
  TriangleMesh mesh;
  const std::uint32_t around = 2 * rings;
  for (std::uint32_t row = 0; row <= rings; ++row) {
    for (std::uint32_t col = 0; col < around; ++col) {
      const double polar = M_PI * row / rings;
      const double turn = 2 * M_PI * col / around;
      mesh.vertices.emplace_back(Eigen::Vector3d(std::sin(polar) * std::cos(turn),
                                                 std::sin(polar) * std::sin(turn),
                                                 std::cos(polar))
                                     .cast<float>());
    }
  }
  for (std::uint32_t row = 0; row < rings; ++row) {
    for (std::uint32_t col = 0; col < around; ++col) {
      const std::uint32_t next = (col + 1) % around;
      const std::uint32_t a = row * around + col;
      const std::uint32_t b = row * around + next;
      mesh.triangles.push_back({a, a + around, b});
      mesh.triangles.push_back({b, a + around, b + around});
    }
  }
  return mesh;
}

TEST(MeshDeviations, HaveTheSignOfTheSideEverywhereAroundAcuteEdges) {
  const TriangleMesh mesh = tetrahedron();
  Random random(3);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20000; ++i) {
    points.emplace_back(static_cast<float>(3 * random.uniform() - 1),
                        static_cast<float>(3 * random.uniform() - 1),
                        static_cast<float>(6 * random.uniform() - 1.5));
  }
  const Deviations deviations = deviations_from_mesh(points, mesh);
  ASSERT_TRUE(deviations.has_sign);
  EXPECT_EQ(deviations.beyond_rim, 0U);
  std::size_t within = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool in = inside(mesh, points[i].cast<double>());
    within += in ? 1 : 0;
    EXPECT_EQ(deviations.values[i] < 0, in) << points[i].transpose();
  }
  EXPECT_GT(within, 50U);
}

TEST(MeshDeviations, FromABallAreTheRadiusLessOne) {
  const TriangleMesh mesh = ball(120);
  Random random(4);
  std::vector<Eigen::Vector3f> points;
  std::vector<double> radius;
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d direction =
        Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
    radius.push_back(0.5 + random.uniform());
    points.emplace_back((radius.back() * direction).cast<float>());
  }
  const Deviations deviations = deviations_from_mesh(points, mesh);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(deviations.values[i], radius[i] - 1, 5e-4);  // the mesh is cut into flats
  }
}

TEST(MeshDeviations, OfAnOpenSheetTellTheSideAndTheRim) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Deviations deviations = deviations_from_mesh(
      {{0.5F, 0.5F, 0.25F}, {0.5F, 0.25F, -0.5F}, {2, 0.5F, 0}, {kNan, 0, 0}, {0.5F, 0.5F, 9}},
      mesh,
      {.max_distance = 2});
  EXPECT_NEAR(deviations.values[0], 0.25, 1e-7);
  EXPECT_NEAR(deviations.values[1], -0.5, 1e-7);
  EXPECT_NEAR(std::abs(deviations.values[2]), 1, 1e-7);
  EXPECT_TRUE(std::isnan(deviations.values[3]));
  EXPECT_TRUE(std::isnan(deviations.values[4]));
  EXPECT_EQ(deviations.beyond_rim, 1U);
  EXPECT_EQ(deviations.too_far, 1U);
  EXPECT_EQ(deviations.not_finite, 1U);
}

TEST(CloudDeviations, AreDistancesWithoutNormalsAndSignedWithThem) {
  PointCloud reference;
  for (int row = 0; row < 20; ++row) {
    for (int col = 0; col < 20; ++col) {
      reference.points.emplace_back(
          0.1F * static_cast<float>(col), 0.1F * static_cast<float>(row), 0.F);
    }
  }
  const std::vector<Eigen::Vector3f> points{{0.55F, 0.55F, 0.02F}, {0.55F, 0.55F, -0.02F}};
  const Deviations plain = deviations_from_cloud(points, reference);
  EXPECT_FALSE(plain.has_sign);
  EXPECT_NEAR(plain.values[0], std::sqrt(0.05 * 0.05 * 2 + 0.02 * 0.02), 1e-6);
  reference.normals.assign(reference.size(), Eigen::Vector3f::UnitZ());
  const Deviations signed_ones = deviations_from_cloud(points, reference);
  EXPECT_TRUE(signed_ones.has_sign);
  EXPECT_NEAR(signed_ones.values[0], 0.02, 1e-7);
  EXPECT_NEAR(signed_ones.values[1], -0.02, 1e-7);
  EXPECT_EQ(deviations_from_cloud({{5, 5, 5}}, reference, {.max_distance = 1}).too_far, 1U);
}

TEST(Deviations, AreTheSameForAnyNumberOfThreads) {
  const TriangleMesh mesh = ball(20);
  const std::vector<Eigen::Vector3f> points = ball(47).vertices;
  EXPECT_EQ(deviations_from_mesh(points, mesh, {.num_threads = 1}).values,
            deviations_from_mesh(points, mesh, {.num_threads = 2}).values);
}

TEST(Deviations, RefuseReferencesWithoutASurface) {
  EXPECT_THROW(deviations_from_mesh({{0, 0, 0}}, {}), Error);
  TriangleMesh mesh;
  mesh.vertices.assign(3, Eigen::Vector3f(kNan, 0, 0));
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THROW(deviations_from_mesh({{0, 0, 0}}, mesh), Error);
  EXPECT_THROW(deviations_from_cloud({{0, 0, 0}}, {}), Error);
  EXPECT_THROW(deviations_from_mesh({{0, 0, 0}}, ball(4), {.max_distance = 0}), Error);
  EXPECT_TRUE(deviations_from_mesh({}, ball(4)).values.empty());
}

TEST(DeviationStatistics, AreThoseOfKnownNumbers) {
  std::vector<double> values(101);
  std::iota(values.begin(), values.end(), -40.0);  // -40 to 60
  values.push_back(kNan);
  const DeviationStatistics s = deviation_statistics(values);
  EXPECT_EQ(s.count, 101U);
  EXPECT_NEAR(s.mean, 10, 1e-12);
  EXPECT_EQ(s.median, 10);
  EXPECT_NEAR(s.standard_deviation, std::sqrt(101.0 * 102 / 12), 1e-9);
  EXPECT_NEAR(s.rms, std::sqrt(100 + 850.0), 1e-9);  // 850 = (101^2 - 1) / 12
  EXPECT_EQ(s.median_absolute, 25);                  // 0, twice 1 to 40, then 41 to 60
  EXPECT_EQ(s.p95_absolute, 55);
  EXPECT_EQ(s.max_absolute, 60);
  EXPECT_EQ(s.least, -40);
  EXPECT_EQ(deviation_statistics({}).count, 0U);
  EXPECT_EQ(deviation_statistics({2.0}).standard_deviation, 0);
}

TEST(DeviationBins, HoldEveryValueOnce) {
  Random random(9);
  std::vector<double> values;
  for (int i = 0; i < 10000; ++i) values.push_back(random.normal());
  const DeviationBins bins = bin_deviations(values, 40);
  EXPECT_EQ(bins.low, -bins.high);
  EXPECT_EQ(std::accumulate(bins.counts.begin(), bins.counts.end(), bins.below + bins.above),
            10000U);
  EXPECT_LE(bins.below + bins.above, 101U);
  EXPECT_NEAR(static_cast<double>(bins.counts[20]) / 10000, 0.3989 * 2 * bins.high / 40, 0.01);
  EXPECT_EQ(bin_deviations({1, 1, 1}, 3).counts[2], 3U);
  EXPECT_NEAR(typical_reach(values), 2.81, 0.15);          // of a normal distribution
  for (std::size_t i = 0; i < 200; ++i) values[i] = 1000;  // strays do not stretch it
  EXPECT_NEAR(typical_reach(values), 5, 0.5);
  EXPECT_EQ(bin_deviations({}, 3).counts.size(), 3U);
}

}  // namespace
}  // namespace facula
