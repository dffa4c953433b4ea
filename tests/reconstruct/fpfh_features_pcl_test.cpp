// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/pcl_bridge.hpp>
#include <facula/reconstruct/register/fpfh_features.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>

#include <gtest/gtest.h>
#include <pcl/features/fpfh.h>
#include <pcl/search/kdtree.h>

namespace facula {
namespace {

PointCloud bumpy_ball() {
  PointCloud cloud = sphere_points(1500, 1);
  for (Eigen::Vector3f& p : cloud.points) {
    cloud.normals.push_back(p.normalized());
    p *= 1 + 0.1F * std::sin(5 * p.x()) * std::cos(4 * p.y());
  }
  return cloud;
}

TEST(FpfhFeatures, EqualThoseOfPclsOwnLoop) {
  const PointCloud cloud = bumpy_ball();
  const double radius = 0.25;
  const auto features = fpfh_features(cloud, {.radius = radius});
  const auto points = to_pcl_with_normals(cloud);
  pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(points);
  estimation.setInputNormals(points);
  estimation.setSearchMethod(
      pcl::search::KdTree<pcl::PointNormal>::Ptr(new pcl::search::KdTree<pcl::PointNormal>()));
  estimation.setRadiusSearch(radius);
  pcl::PointCloud<pcl::FPFHSignature33> expected;
  estimation.compute(expected);
  ASSERT_EQ(features.size(), expected.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (std::size_t bin = 0; bin < kFpfhBins; ++bin) {
      ASSERT_NEAR(features[i][bin], expected[i].histogram[bin], 1e-3);
    }
  }
}

TEST(FpfhFeatures, DoNotDependOnThePoseNorOnTheThreads) {
  const PointCloud cloud = bumpy_ball();
  const auto features = fpfh_features(cloud, {.radius = 0.25, .num_threads = 1});
  EXPECT_EQ(features, fpfh_features(cloud, {.radius = 0.25, .num_threads = 2}));
  Eigen::Matrix<double, 6, 1> twist;
  twist << 0.3, -0.2, 0.5, 0.4, 1.1, -0.7;
  const auto moved =
      fpfh_features(transformed(cloud, exp_se3(twist)), {.radius = 0.25, .num_threads = 1});
  // Rounding takes a few pairs of points across the edge of a bin or of the neighbourhood.
  int differing = 0;
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (std::size_t bin = 0; bin < kFpfhBins; ++bin) {
      if (std::abs(features[i][bin] - moved[i][bin]) > 2) ++differing;
    }
  }
  EXPECT_LT(differing, 0.01 * double(features.size()) * kFpfhBins);
}

TEST(FpfhFeatures, MarksLonelyPointsAndRefusesWhatItCannotUse) {
  PointCloud cloud = bumpy_ball();
  cloud.points.emplace_back(50, 0, 0);
  cloud.normals.emplace_back(0, 0, 1);
  const auto features = fpfh_features(cloud, {.radius = 0.25});
  EXPECT_TRUE(std::isnan(features.back()[0]));
  EXPECT_FALSE(std::isnan(features.front()[0]));
  EXPECT_TRUE(fpfh_features({}, {.radius = 1}).empty());
  EXPECT_THROW(fpfh_features(cloud, {.radius = 0}), Error);
  cloud.points[3].x() = NAN;
  EXPECT_THROW(fpfh_features(cloud, {.radius = 0.25}), Error);
  cloud.normals.clear();
  EXPECT_THROW(fpfh_features(cloud, {.radius = 0.25}), Error);
}

}  // namespace
}  // namespace facula
