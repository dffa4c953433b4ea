// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/tests/support/matchers.hpp>

#include <array>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

namespace facula {
namespace {

PointCloud random_cloud(std::size_t count) {
  Random random(5);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.emplace_back(
        float(random.normal()), float(random.normal()), float(random.uniform()));
    cloud.intensity.push_back(float(random.uniform()));
  }
  return cloud;
}

struct Sum {
  double weight = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double intensity = 0;
};

/// Voxel means by a map of cells, ordered by z, y, x.
std::map<std::array<long, 3>, Sum> brute_force(const PointCloud& cloud, double voxel) {
  std::map<std::array<long, 3>, Sum> sums;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.points[i].cast<double>();
    const Eigen::Array3d cell = (p.array() / voxel).floor();
    Sum& sum = sums[{long(cell.z()), long(cell.y()), long(cell.x())}];
    const double w = cloud.sigma.empty() ? 1 : 1 / std::pow(double(cloud.sigma[i]), 2);
    sum.weight += w;
    sum.point += w * p;
    sum.intensity += w * cloud.intensity[i];
  }
  return sums;
}

void expect_equals_brute_force(const PointCloud& cloud, double voxel) {
  const PointCloud thinned = thin_by_voxel(cloud, voxel);
  const auto expected = brute_force(cloud, voxel);
  ASSERT_EQ(thinned.size(), expected.size());
  std::size_t i = 0;
  for (const auto& [cell, sum] : expected) {
    EXPECT_TRUE(is_near_point(thinned.points[i].cast<double>(), sum.point / sum.weight, 1e-6));
    EXPECT_NEAR(thinned.intensity[i], sum.intensity / sum.weight, 1e-6);
    if (!cloud.sigma.empty()) {
      EXPECT_NEAR(thinned.sigma[i], 1 / std::sqrt(sum.weight), 1e-8);
    }
    ++i;
  }
}

TEST(ThinByVoxel, GivesTheMeanOfEveryVoxelInOrder) {
  expect_equals_brute_force(random_cloud(20000), 0.25);
}

TEST(ThinByVoxel, WeighsPointsByTheirSigma) {
  PointCloud cloud = random_cloud(5000);
  Random random(6);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.sigma.push_back(float(1e-3 * (1 + random.uniform())));
  }
  expect_equals_brute_force(cloud, 0.4);
}

TEST(ThinByVoxel, RenormalisesNormalsAndAveragesColors) {
  PointCloud cloud;
  cloud.points = {{0.1F, 0.1F, 0.1F}, {0.2F, 0.2F, 0.2F}};
  cloud.normals = {Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY()};
  cloud.colors = {{10, 20, 30}, {20, 40, 60}};
  const PointCloud thinned = thin_by_voxel(cloud, 1.0);
  ASSERT_EQ(thinned.size(), 1U);
  EXPECT_TRUE(is_near_point(thinned.normals[0].cast<double>(), {M_SQRT1_2, M_SQRT1_2, 0}, 1e-6));
  EXPECT_EQ(thinned.colors[0], (Color{15, 30, 45}));
}

TEST(ThinByVoxel, DropsPointsThatAreNotFiniteAndBearsNone) {
  PointCloud cloud;
  EXPECT_TRUE(thin_by_voxel(cloud, 0.1).empty());
  cloud.points = {{NAN, 0, 0}, {1, 1, 1}, {0, INFINITY, 0}};
  EXPECT_EQ(thin_by_voxel(cloud, 0.1).size(), 1U);
}

TEST(ThinByVoxel, RefusesACloudTooWideForItsKeys) {
  PointCloud cloud;
  cloud.points = {{0, 0, 0}, {3000, 0, 0}};
  EXPECT_EQ(thin_by_voxel(cloud, 0.0015).size(), 2U);
  EXPECT_NE(error_of([&] { thin_by_voxel(cloud, 0.001); }).find("larger voxel"), std::string::npos);
  EXPECT_NE(error_of([&] { thin_by_voxel(cloud, 0); }), "");
  EXPECT_NE(error_of([&] { thin_by_voxel(cloud, NAN); }), "");
}

TEST(ThinByVoxel, TakesASigmaOfZeroForUnknownAndNotForPerfect) {
  PointCloud cloud;
  cloud.points = {{0.1F, 0, 0}, {0.3F, 0, 0}, {0.8F, 0, 0}, {1.2F, 0, 0}, {1.4F, 0, 0}};
  cloud.sigma = {0.001F, 0.001F, 0.0F, 0.0F, INFINITY};
  const PointCloud thinned = thin_by_voxel(cloud, 1.0);
  ASSERT_EQ(thinned.size(), 2U);
  // Two points that know their sigma outdo the third; in the second voxel none does.
  EXPECT_NEAR(thinned.points[0].x(), 0.2, 1e-6);
  EXPECT_NEAR(thinned.sigma[0], 0.001 / std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(thinned.points[1].x(), 1.3, 1e-6);
  EXPECT_EQ(thinned.sigma[1], 0);
}

}  // namespace
}  // namespace facula
