// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

/// The plane whose normal is nearest to `normal` (either way) at `distance` along it.
const ExtractedPlane* find_plane(const std::vector<ExtractedPlane>& planes,
                                 const Plane& wanted,
                                 double max_angle,
                                 double max_distance) {
  for (const ExtractedPlane& plane : planes) {
    if (angle_between(plane.fit.plane, wanted) < max_angle &&
        std::abs(wanted.signed_distance(plane.fit.centroid)) < max_distance) {
      return &plane;
    }
  }
  return nullptr;
}

struct Room {
  PointCloud cloud;
  std::vector<Plane> truth;
};

/// A box of 4 x 3 x 2.5 m whose far wall stands 80 degrees to its neighbour.
Room skewed_room(std::size_t points_per_square_metre, double sigma) {
  const double lean = 3 * std::tan(10 * kDegree);
  const Eigen::Vector3d x(4, 0, 0);
  const Eigen::Vector3d y(0, 3, 0);
  const Eigen::Vector3d z(0, 0, 2.5);
  const Eigen::Vector3d o(-1, -1, -1);
  const std::vector<Patch> patches = {{o, x, y},
                                      {o + z, x, y},
                                      {o, x, z},
                                      {o + y, x, z},
                                      {o, y, z},
                                      {o + x, y + Eigen::Vector3d(lean, 0, 0), z}};
  Room room;
  Random random(9);
  for (const Patch& patch : patches) {
    const Eigen::Vector3d normal = patch.side_u.cross(patch.side_v);
    const auto count = static_cast<std::size_t>(normal.norm() * double(points_per_square_metre));
    add_patch(room.cloud, patch, count, sigma, random);
    room.truth.push_back({normal.normalized(), normal.normalized().dot(patch.corner)});
  }
  return room;
}

TEST(ExtractPlanes, FindsTheSixWallsOfARoomAndTheirAngles) {
  const Room room = skewed_room(1500, 0.002);
  const auto planes = extract_planes(room.cloud);
  EXPECT_EQ(planes.size(), 6U);
  std::vector<const ExtractedPlane*> found;
  for (const Plane& wall : room.truth) {
    const ExtractedPlane* plane = find_plane(planes, wall, 0.1 * kDegree, 0.001);
    ASSERT_NE(plane, nullptr) << wall.normal.transpose();
    found.push_back(plane);
  }
  for (std::size_t a = 0; a < found.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      EXPECT_NEAR(angle_between(found[a]->fit.plane, found[b]->fit.plane),
                  angle_between(room.truth[a], room.truth[b]),
                  0.1 * kDegree);
    }
  }
  EXPECT_NEAR(distance_between(found[0]->fit, found[1]->fit), 2.5, 0.0005);
  for (std::size_t i = 1; i < planes.size(); ++i) {
    EXPECT_GE(planes[i - 1].indices.size(), planes[i].indices.size());
  }
}

TEST(ExtractPlanes, GivesNoPointToTwoPlanes) {
  std::set<std::size_t> taken;
  for (const auto& plane : extract_planes(skewed_room(500, 0.002).cloud)) {
    for (const std::size_t i : plane.indices) EXPECT_TRUE(taken.insert(i).second);
  }
  EXPECT_GT(taken.size(), 20000U);
}

TEST(ExtractPlanes, SeparatesParallelStepsFiveMillimetresApart) {
  PointCloud cloud;
  Random random(12);
  for (int step = 0; step < 4; ++step) {
    const Eigen::Vector3d corner(0.03 * step, 0, 0.3 + 0.005 * step);
    add_patch(cloud, {corner, {0.03, 0, 0}, {0, 0.1, 0}}, 4000, 0.0002, random);
  }
  const auto planes = extract_planes(cloud, {.inlier_distance = 0.001});
  ASSERT_EQ(planes.size(), 4U);
  std::vector<const PlaneFit*> fits;
  for (const auto& plane : planes) fits.push_back(&plane.fit);
  std::sort(
      fits.begin(), fits.end(), [](auto a, auto b) { return a->centroid.z() < b->centroid.z(); });
  for (std::size_t i = 1; i < 4; ++i) {
    EXPECT_LT(angle_between(fits[i]->plane, fits[i - 1]->plane), 0.1 * kDegree);
    EXPECT_NEAR(distance_between(*fits[i], *fits[i - 1]), 0.005, 0.00005);
  }
}

TEST(ExtractPlanes, KeepsOnlyTheLargestPieceOfCoplanarSurfaces) {
  PointCloud cloud;
  Random random(13);
  add_patch(cloud, {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, 6000, 0.001, random);
  add_patch(cloud, {{5, 0, 1}, {0.5, 0, 0}, {0, 1, 0}}, 3000, 0.001, random);
  const auto planes = extract_planes(cloud);
  ASSERT_EQ(planes.size(), 2U);
  EXPECT_NEAR(planes[0].fit.extent, 1, 0.02);
  EXPECT_EQ(planes[0].indices.size(), 6000U);
  EXPECT_NEAR(planes[1].fit.width, 0.5, 0.02);
  EXPECT_EQ(planes[1].indices.size(), 3000U);
}

TEST(ExtractPlanes, UsesNormalsToLeaveCrossingStripsAside) {
  Room room = skewed_room(2000, 0.001);
  room.cloud.sensor_origin.assign(room.cloud.size(), Eigen::Vector3f(0.5F, 0.5F, 0.2F));
  estimate_normals(room.cloud);
  const auto planes = extract_planes(room.cloud, {.inlier_distance = 0.05});
  for (const auto& plane : planes) {
    for (const std::size_t i : plane.indices) {
      const double cosine = room.cloud.normals[i].cast<double>().dot(plane.fit.plane.normal);
      EXPECT_GE(std::abs(cosine), std::cos(0.65));
    }
  }
  for (const Plane& wall : room.truth) {
    EXPECT_NE(find_plane(planes, wall, 0.05 * kDegree, 0.001), nullptr);
  }
}

TEST(ExtractPlanes, RepeatsItselfWithTheSameSeed) {
  const PointCloud cloud = skewed_room(400, 0.003).cloud;
  const auto first = extract_planes(cloud, {.seed = 5});
  const auto second = extract_planes(cloud, {.seed = 5});
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].indices, second[i].indices);
}

TEST(ExtractPlanes, FindsNothingInNothingOrInNoise) {
  EXPECT_TRUE(extract_planes({}).empty());
  PointCloud noise;
  Random random(14);
  for (int i = 0; i < 5000; ++i) {
    noise.points.emplace_back(
        float(random.normal()), float(random.normal()), float(random.normal()));
  }
  EXPECT_TRUE(extract_planes(noise).empty());
  PointCloud spot;
  spot.points.assign(2000, Eigen::Vector3f(1, 2, 3));
  EXPECT_TRUE(extract_planes(spot).empty());
}

/// A round pot: wall and floor, seen from outside.
PointCloud round_pot(double radius, double sigma) {
  PointCloud cloud;
  Random random(31);
  for (int i = 0; i < 30000; ++i) {
    const double turn = 2 * M_PI * random.uniform();
    const double r = radius + sigma * random.normal();
    const double z = 2 * radius * random.uniform();
    cloud.points.emplace_back(float(r * std::cos(turn)), float(r * std::sin(turn)), float(z));
    cloud.normals.emplace_back(float(std::cos(turn)), float(std::sin(turn)), 0.0F);
  }
  return cloud;
}

TEST(ExtractPlanes, FindsNoPlaneOnARoundPot) {
  const PointCloud pot = round_pot(0.05, 0.0001);
  EXPECT_TRUE(extract_planes(pot).empty());
  // Nor with a band so wide that the slices are large; without the judge they are planes.
  EXPECT_TRUE(extract_planes(pot, {.inlier_distance = 0.002}).empty());
  EXPECT_GE(extract_planes(pot, {.inlier_distance = 0.002, .max_bend = 3}).size(), 6U);
}

TEST(ExtractPlanes, FindsTheFloorUnderARoundPot) {
  PointCloud cloud = round_pot(0.05, 0.0001);
  Random random(32);
  add_patch(cloud, {{-0.1, -0.1, 0}, {0.2, 0, 0}, {0, 0.2, 0}}, 8000, 0.0001, random);
  cloud.normals.resize(cloud.size(), Eigen::Vector3f::UnitZ());
  const auto planes = extract_planes(cloud);
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_LT(angle_between(planes[0].fit.plane, {Eigen::Vector3d::UnitZ(), 0}), 0.02 * kDegree);
}

TEST(ExtractPlanes, KeepsAWallThatBowsALittle) {
  PointCloud wall;
  Random random(33);
  for (int i = 0; i < 20000; ++i) {
    const double x = 4 * random.uniform() - 2;
    const double bow = 0.005 * (1 - x * x / 4);  // 5 mm over 4 m
    wall.points.emplace_back(
        float(x), float(2.5 * random.uniform()), float(3 + bow + 0.001 * random.normal()));
  }
  const auto planes = extract_planes(wall);
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_GT(planes[0].fit.extent, 3.9);
}

TEST(DefaultInlierDistance, IsFourTimesTheNoiseWhateverTheSampling) {
  for (const double sigma : {0.0002, 0.002, 0.01}) {
    for (const std::size_t count : {3000U, 60000U}) {
      PointCloud wall;
      Random random(34);
      add_patch(wall, {{0, 0, 2}, {1, 0, 0}, {0, 1, 0}}, count, sigma, random);
      EXPECT_NEAR(default_inlier_distance(wall) / (4 * sigma), 1, 0.2) << sigma << " " << count;
    }
  }
}

TEST(DefaultInlierDistance, IsNotTakenWithinTheStripesOfALineScanner) {
  PointCloud wall;
  Random random(35);
  for (int stripe = 0; stripe < 40; ++stripe) {  // each in a plane of its own, 50 mm apart
    for (int i = 0; i < 500; ++i) {
      wall.points.emplace_back(
          0.05F * float(stripe), 0.004F * float(i), float(2 + 0.003 * random.normal()));
      wall.sensor_origin.emplace_back(0.001F * float(stripe), 0.0F, 0.0F);
    }
  }
  EXPECT_NEAR(default_inlier_distance(wall), 0.012, 0.003);
}

TEST(ExtractPlanes, IsTheSameForAnyNumberOfThreads) {
  PointCloud cloud = skewed_room(800, 0.003).cloud;
  const auto one = extract_planes(cloud, {.num_threads = 1});
  const auto two = extract_planes(cloud, {.num_threads = 2});
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].indices, two[i].indices);
    EXPECT_EQ(one[i].fit.plane.normal, two[i].fit.plane.normal);
    EXPECT_EQ(one[i].fit.covariance, two[i].fit.covariance);
  }
}

TEST(ExtractPlanes, PassesOverPointsThatAreNotFinite) {
  Room room = skewed_room(400, 0.001);
  const std::size_t planes = extract_planes(room.cloud).size();
  room.cloud.points[7].x() = std::nanf("");
  room.cloud.points.emplace_back(INFINITY, 0.0F, 0.0F);
  EXPECT_EQ(extract_planes(room.cloud).size(), planes);
  const PointCloud line{.points = std::vector<Eigen::Vector3f>(600, {1, 2, 3})};
  EXPECT_TRUE(extract_planes(line).empty());
  EXPECT_TRUE(extract_planes({.points = {{1, 2, 3}}}).empty());
}

TEST(ExtractPlanes, RefusesOptionsOutOfRange) {
  EXPECT_NE(error_of([] { extract_planes({}, {.max_bend = 0}); }), "");
  EXPECT_NE(error_of([] { extract_planes({}, {.inlier_distance = 0.0}); }), "");
  EXPECT_NE(error_of([] { extract_planes({}, {.min_points = 2}); }), "");
  EXPECT_NE(error_of([] { extract_planes({}, {.max_planes = 0}); }), "");
  EXPECT_NE(error_of([] { extract_planes({}, {.max_normal_angle = 2}); }), "");
}

TEST(ExtractPlanesRealData, FindsThePublishedPlaneOfPclsOwnTest) {
  FACULA_REQUIRE_REAL_DATA(file, "range/pcl-test/sac_plane_test.pcd");
  // PCL's test expects a/d, b/d, c/d = -0.8964, -0.5868, -1.208 and counts points within 3 cm.
  const Eigen::Vector3d ratio(-0.8964, -0.5868, -1.208);
  const Plane published{-ratio.normalized(), 1 / ratio.norm()};
  const auto planes = extract_planes(read_cloud(file), {.inlier_distance = 0.03});
  ASSERT_FALSE(planes.empty());
  EXPECT_LT(angle_between(planes[0].fit.plane, published), 0.5 * kDegree);
  EXPECT_NEAR(planes[0].fit.plane.distance, published.distance, 0.01);
}

}  // namespace
}  // namespace facula
