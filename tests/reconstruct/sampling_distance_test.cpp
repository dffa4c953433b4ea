// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// Stripes 5 mm apart with a point every 0.2 mm.
PointCloud striped_plane(bool with_origins) {
  PointCloud cloud;
  for (int stripe = 0; stripe < 20; ++stripe) {
    for (int i = 0; i < 500; ++i) {
      cloud.points.emplace_back(0.005F * stripe, 0.0002F * i, 0);
      if (with_origins) cloud.sensor_origin.emplace_back(0.005F * stripe, 0, 1);
    }
  }
  return cloud;
}

TEST(SamplingDistance, TellsTheStripeFromTheStep) {
  const SamplingDistance distance = sampling_distance(striped_plane(true));
  EXPECT_NEAR(distance.nearest, 0.0002, 1e-6);
  EXPECT_NEAR(distance.across, 0.005, 1e-6);
}

TEST(SamplingDistance, IsTheNearestWhereAllShareOneOrigin) {
  const SamplingDistance distance = sampling_distance(striped_plane(false));
  EXPECT_NEAR(distance.across, 0.0002, 1e-6);
}

TEST(SamplingDistance, EvensOutOnlyWhatIsUneven) {
  EXPECT_NEAR(evening_voxel(striped_plane(true)), 0.0025, 1e-6);
  EXPECT_EQ(evening_voxel(striped_plane(false)), 0);
}

/// Twenty neighbours of a point on its own stripe reach 2 mm, the next stripe is 5 mm away.
TEST(EstimateNormals, SeesTheSurfaceBetweenStripesFarApart) {
  PointCloud cloud = striped_plane(true);
  estimate_normals(cloud);
  for (const Eigen::Vector3f& normal : cloud.normals) EXPECT_GT(normal.z(), 0.999F);
}

TEST(SamplingDistance, IsZeroWithoutPoints) {
  EXPECT_EQ(sampling_distance({}).across, 0);
}

}  // namespace
}  // namespace facula
