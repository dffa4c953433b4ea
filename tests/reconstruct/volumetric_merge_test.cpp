// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>
#include <facula/reconstruct/mesh/sight_prism.hpp>
#include <facula/reconstruct/mesh/volumetric_merge.hpp>
#include <facula/tests/reconstruct/simulated_grids.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kRadius = 0.1;

ScanProject sphere_scans() {
  return six_views(sphere_range(kRadius), 1, {.eye = {}, .target = {}, .half_angle = 0.12});
}

/// A square plate of half side `half` across z, its two faces at +thickness/2 and -thickness/2.
RayRange plate_range(double half, double thickness) {
  return [=](const Eigen::Vector3d& eye, const Eigen::Vector3d& way) {
    const double r = ((eye.z() > 0 ? thickness / 2 : -thickness / 2) - eye.z()) / way.z();
    const Eigen::Vector3d p = eye + r * way;
    return r > 0 && std::abs(p.x()) < half && std::abs(p.y()) < half ? r : NAN;
  };
}

PosedCloud plate_seen_from(double height, double half, double thickness) {
  return simulated_grid({.eye = {0, 0, height}, .target = {0, 0, 0}, .half_angle = 0.12},
                        plate_range(half, thickness));
}

bool same_bits(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

double quantile_of(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

TEST(VolumetricMerge, ClosesASphereSeenFromSixSides) {
  const VolumetricResult merged = merge_volumetric(sphere_scans());
  const MeshStatistics mesh = mesh_statistics(merged.mesh);
  EXPECT_TRUE(mesh.watertight) << mesh.boundary_edges << " boundary edges";
  EXPECT_EQ(mesh.components, 1U);
  // Triangles are chords of the sphere: a little less than its volume, and positive when they look
  // outwards.
  const double volume = 4.0 / 3 * M_PI * std::pow(kRadius, 3);
  EXPECT_NEAR(mesh.volume, volume, 2e-3 * volume);
  for (const Eigen::Vector3f& p : merged.mesh.vertices) {
    ASSERT_NEAR(static_cast<double>(p.norm()), kRadius, 0.05 * merged.voxel);
  }
}

TEST(VolumetricMerge, IsTheSameForOneThreadAndTwo) {
  const ScanProject scans = sphere_scans();
  const VolumetricResult one = merge_volumetric(scans, {.num_threads = 1});
  const VolumetricResult two = merge_volumetric(scans, {.num_threads = 2});
  EXPECT_TRUE(same_bits(one.mesh, two.mesh));
  ASSERT_FALSE(one.mesh.empty());
}

TEST(VolumetricMerge, LeavesOpenWhatNoScanSaw) {
  ScanProject scans = sphere_scans();
  scans.scans.erase(scans.scans.begin());  // the view from +x
  scans.scans.erase(scans.scans.begin() + 1, scans.scans.end());
  const TriangleMesh mesh = merge_volumetric(scans).mesh;
  EXPECT_GT(mesh_statistics(mesh).boundary_edges, 100U);
  for (const Eigen::Vector3f& p : mesh.vertices) ASSERT_LT(p.x(), 0.0F);
}

TEST(VolumetricMerge, DrawsNoSkirtsAtDepthJumpsAndBorders) {
  // A small plate 20 mm before a large one, seen from above only.
  const RayRange two_plates = [](const Eigen::Vector3d& eye, const Eigen::Vector3d& way) {
    const double near = plate_range(0.05, 0.04)(eye, way);
    return std::isnan(near) ? plate_range(0.1, 0)(eye, way) : near;
  };
  ScanProject scans;
  scans.scans.push_back(simulated_grid(
      {.eye = {0.02, 0.01, 1}, .target = {0, 0, 0}, .half_angle = 0.13}, two_plates));
  const VolumetricResult merged = merge_volumetric(scans);
  for (const Eigen::Vector3f& p : merged.mesh.vertices) {
    ASSERT_LT(std::min(std::abs(p.z()), std::abs(p.z() - 0.02F)), 1e-4F);
  }
  EXPECT_GT(merged.mesh.triangles.size(), 5000U);
}

TEST(VolumetricMerge, KeepsAPlateThinnerThanTheBand) {
  ScanProject scans;
  const double thickness = 5e-3;
  scans.scans.push_back(plate_seen_from(1, 0.1, thickness));
  scans.scans.push_back(plate_seen_from(-1, 0.1, thickness));
  const VolumetricResult merged =
      merge_volumetric(scans, {.voxel = 2e-3, .truncation = 6e-3});  // the bands overlap
  std::size_t above = 0;
  std::size_t below = 0;
  for (const Eigen::Vector3f& p : merged.mesh.vertices) {
    ASSERT_NEAR(std::abs(static_cast<double>(p.z())), thickness / 2, 0.5 * merged.voxel);
    ++(p.z() > 0 ? above : below);
  }
  EXPECT_GT(above, 5000U);
  EXPECT_GT(below, 5000U);
}

TEST(VolumetricMerge, WeighsScansByTheirSigma) {
  // The same plate, measured 1 mm too high by the scan of twice the sigma: 1/(1 + 4) of the way.
  ScanProject scans;
  for (const float sigma : {1e-3F, 2e-3F}) {
    PosedCloud scan = plate_seen_from(1, 0.1, 0);
    scan.cloud.sigma.assign(scan.cloud.size(), sigma);
    if (sigma > 1.5e-3F) scan.world_from_scan.translation.z() += 1e-3;
    scans.scans.push_back(scan);
  }
  const VolumetricResult merged = merge_volumetric(scans, {.voxel = 2e-3});
  std::vector<double> heights;
  for (const Eigen::Vector3f& p : merged.mesh.vertices) {
    if (p.head<2>().norm() < 0.08F) heights.push_back(static_cast<double>(p.z()));
  }
  ASSERT_GT(heights.size(), 1000U);
  EXPECT_NEAR(quantile_of(heights, 0.5), 0.2e-3, 0.02e-3);
}

TEST(VolumetricMerge, MergesPointsWithoutAGrid) {
  PosedCloud scan;
  scan.name = "sphere";
  scan.cloud = sphere_points(20000, kRadius);
  for (const Eigen::Vector3f& p : scan.cloud.points) scan.cloud.normals.push_back(p.normalized());
  ScanProject scans;
  scans.scans.push_back(scan);
  const VolumetricResult merged = merge_volumetric(scans);
  EXPECT_TRUE(mesh_statistics(merged.mesh).watertight);
  EXPECT_GT(mesh_statistics(merged.mesh).volume, 0);
  for (const Eigen::Vector3f& p : merged.mesh.vertices) {
    ASSERT_NEAR(static_cast<double>(p.norm()), kRadius, 0.1 * merged.voxel);
  }
}

TEST(VolumetricMerge, RefusesScansWithoutASurface) {
  const auto sentence = [](const PosedCloud& scan) {
    ScanProject scans;
    scans.scans.push_back(scan);
    return error_of([&] { merge_volumetric(scans); });
  };
  PosedCloud scan;
  EXPECT_NE(sentence(scan).find("none of the 1 scans has a surface"), std::string::npos);
  scan.cloud.points = {{0, 0, 0}};
  EXPECT_NE(sentence(scan).find("none of the 1 scans has a surface"), std::string::npos);
  scan.cloud.points.assign(100, {1, 2, 3});
  EXPECT_NE(sentence(scan).find("none of the 1 scans has a surface"), std::string::npos);
  scan.cloud.points.assign(100, Eigen::Vector3f::Constant(NAN));
  EXPECT_NE(sentence(scan).find("none of the 1 scans has a surface"), std::string::npos);
  EXPECT_NE(error_of([] { merge_volumetric({}); }).find("none of the 0 scans"), std::string::npos);
}

TEST(VolumetricMerge, LeavesOutPointsThatAreNotFinite) {
  ScanProject scans = sphere_scans();
  scans.scans[0].cloud.points[1000].setConstant(NAN);
  scans.scans[1].cloud.points[2000].setConstant(INFINITY);
  scans.scans[2].cloud.sensor_origin[500].setConstant(NAN);
  const VolumetricResult merged = merge_volumetric(scans);
  EXPECT_GE(merged.skipped_points, 3U);
  for (const Eigen::Vector3f& p : merged.mesh.vertices) {
    ASSERT_NEAR(static_cast<double>(p.norm()), kRadius, 0.2 * merged.voxel);
  }
}

TEST(VolumetricMerge, SaysWhichPoseIsNotFinite) {
  ScanProject scans = sphere_scans();
  scans.scans[3].name = "chin";
  scans.scans[3].world_from_scan.translation.x() = NAN;
  EXPECT_NE(error_of([&] { merge_volumetric(scans); }).find("'chin'"), std::string::npos);
}

TEST(VolumetricMerge, NamesVoxelAndMemoryWhereTheyDoNotFit) {
  const ScanProject scans = sphere_scans();
  const std::string tiny = error_of([&] { merge_volumetric(scans, {.voxel = 1e-7}); });
  EXPECT_NE(tiny.find("voxels of 0.0001 mm"), std::string::npos) << tiny;
  const std::string small =
      error_of([&] { merge_volumetric(scans, {.voxel = 1e-3, .max_memory = 1e6}); });
  EXPECT_NE(small.find("0.001 GB are allowed"), std::string::npos) << small;
  ScanProject far = sphere_scans();
  far.scans[0].world_from_scan.translation.x() = 1e7;
  EXPECT_NE(
      error_of([&] { merge_volumetric(far, {.voxel = 1e-3}); }).find("from the world's origin"),
      std::string::npos);
  EXPECT_NE(error_of([&] { merge_volumetric(scans, {.voxel = -1}); }).find("voxel is -1"),
            std::string::npos);
}

TEST(SightPrism, NamesNoMoreBricksThanItSays) {
  Random random(6);
  const auto vector = [&random](double scale) {
    return Eigen::Vector3f(
        (scale * Eigen::Vector3d(random.normal(), random.normal(), random.normal())).cast<float>());
  };
  std::size_t usable = 0;
  for (int i = 0; i < 300; ++i) {
    RangeSurface surface;
    const Eigen::Vector3f toward = vector(1).normalized();
    for (int corner = 0; corner < 3; ++corner) {
      surface.vertices.push_back({.point = vector(i % 3 == 0 ? 0.002 : 0.05),
                                  .toward = (toward + vector(0.1)).normalized()});
    }
    const SightPrism prism(surface, {0, 1, 2}, 1e-3, 3);
    if (!prism.usable()) continue;
    ++usable;
    std::size_t named = 0;
    prism.visit_bricks([&named](const BrickPlace&) { ++named; });
    EXPECT_LE(static_cast<double>(named), prism.bricks_at_most());
  }
  EXPECT_GT(usable, 200U);
}

TEST(VolumetricMerge, AgreesWithTheZipperedBunny) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  const ScanProject scans = read_scan_project(folder / "data/bun.conf");
  const PosedCloud zipper =
      read_scan_project(folder / "reconstruction/bun_zipper.ply").scans.front();
  const VolumetricResult merged = merge_volumetric(scans);
  const MeshStatistics mesh = mesh_statistics(merged.mesh);
  EXPECT_EQ(mesh.non_manifold_edges, 0U);
  const std::vector<double> away = distances_to_mesh(zipper.cloud.points, merged.mesh);
  EXPECT_LT(quantile_of(away, 0.5), 0.035e-3);
  EXPECT_LT(quantile_of(away, 0.95), 0.14e-3);
}

}  // namespace
}  // namespace facula
