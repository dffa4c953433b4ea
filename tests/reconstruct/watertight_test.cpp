// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/mesh/mesh_engines.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>
#include <facula/reconstruct/mesh/volumetric_merge.hpp>
#include <facula/reconstruct/mesh/watertight.hpp>
#include <facula/tests/reconstruct/mesh_shapes.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// What make_watertight() says of itself must be what a fresh judge finds.
void expect_watertight(const WatertightResult& result) {
  const MeshVerdict fresh = judge_mesh(result.mesh);
  EXPECT_TRUE(fresh.watertight()) << result.how << ": " << fresh.sentence();
  EXPECT_EQ(fresh.self_intersections, 0U);
  EXPECT_TRUE(result.verdict.watertight());
}

TEST(Watertight, LeavesAClosedMeshAlone) {
  const TriangleMesh sphere = sphere_mesh(1, 4);
  const WatertightResult result = make_watertight(sphere);
  expect_watertight(result);
  EXPECT_EQ(result.mesh.vertices, sphere.vertices);
  EXPECT_EQ(result.holes_filled, 0U);
}

TEST(Watertight, ClosesAHalfSphereOfNoisyPoints) {
  PointCloud cloud;
  Random random(11);
  for (const Eigen::Vector3f& p : sphere_points(6000, 1.0).points) {
    if (p.z() < 0) continue;
    cloud.points.push_back(p * float(1 + 0.003 * random.normal()));
    cloud.sensor_origin.push_back(4 * p);
  }
  const TriangleMesh open = mesh_advancing_front(cloud);
  EXPECT_FALSE(judge_mesh(open).closed);
  const WatertightResult result = make_watertight(open, cloud.points);
  expect_watertight(result);
  EXPECT_NEAR(*result.verdict.volume, 2 * M_PI / 3, 0.1);
  EXPECT_LT(result.verdict.deviation->median, 0.002);
}

TEST(Watertight, ClosesScansFullOfHoles) {
  TriangleMesh holed = torus(1, 0.4, 90, 45);
  const double whole = judge_mesh(holed).volume.value();
  Random random(3);
  std::vector<Eigen::Vector3f> centres;
  for (int i = 0; i < 12; ++i)
    centres.push_back(holed.vertices[random.below(holed.vertices.size())]);
  holed = without(holed, [&](const Eigen::Vector3f& c) {
    for (const Eigen::Vector3f& centre : centres) {
      if ((c - centre).norm() < 0.12F) return true;
    }
    return false;
  });
  EXPECT_GE(judge_mesh(holed).loops.size(), 8U);
  const WatertightResult result = make_watertight(holed);
  expect_watertight(result);
  EXPECT_FALSE(result.wrapped);
  EXPECT_EQ(result.verdict.genus, 1) << "the torus keeps its handle";
  EXPECT_NEAR(*result.verdict.volume, std::abs(whole), 0.02);
}

TEST(Watertight, ClosesAThinPlateWithARaggedRim) {
  // Two noisy faces 2 mm apart that were not joined at their rims.
  Random random(8);
  TriangleMesh plate;
  for (const double z : {0.0, 0.002}) {
    TriangleMesh face = grid_surface(41, 41, [&](double u, double v) {
      return Eigen::Vector3d(0.1 * v, 0.1 * u, z + 5e-5 * random.normal());
    });
    if (z == 0) {
      for (auto& t : face.triangles) std::swap(t[0], t[1]);
    }
    add_mesh(plate, face, {0, 0, 0});
  }
  const WatertightResult result = make_watertight(plate);
  expect_watertight(result);
  // Two faces of 0.01 m^2, a rim of 0.4 m x 2 mm, and an offset of a millimetre or two about them.
  EXPECT_NEAR(result.verdict.statistics.area, 0.0225, 0.003) << result.how;
  EXPECT_LT(deviation_from_mesh(plate.vertices, result.mesh).max, 0.002) << result.how;
}

TEST(Watertight, CutsOutWhereTrianglesCutEachOther) {
  TriangleMesh spiked = sphere_mesh(1, 4);
  spiked.vertices[200] *= -0.2F;  // one vertex through to the other side's inside
  spiked.vertices[700] *= -1.3F;  // and one out of it
  EXPECT_GT(judge_mesh(spiked).self_intersections, 0U);
  const WatertightResult result = make_watertight(spiked);
  expect_watertight(result);
  EXPECT_NEAR(*result.verdict.volume, 4 * M_PI / 3, 0.15);
}

TEST(Watertight, WrapsWhatFillingCannotCloseOrSaysWhy) {
  // Two spheres through each other: two closed pieces that no filling can part.
  TriangleMesh spheres = sphere_mesh(1, 3);
  add_mesh(spheres, sphere_mesh(1, 3), {0.9F, 0.1F, 0.05F});
  const std::string refusal =
      error_of([&] { make_watertight(spheres, {}, {.rounds = 0, .allow_wrap = false}); });
  EXPECT_NE(refusal.find("cut each other"), std::string::npos) << refusal;
  const WatertightResult result = make_watertight(spheres, {}, {.rounds = 0});
  expect_watertight(result);
  EXPECT_TRUE(result.wrapped);
}

TEST(Watertight, RefusesNothing) {
  EXPECT_NE(error_of([] { make_watertight({}); }).find("no triangles"), std::string::npos);
  TriangleMesh flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  flat.triangles = {{0, 1, 2}};
  EXPECT_NE(error_of([&] { make_watertight(flat); }), "");
}

TEST(Watertight, ClosesTheTenBunnyScansWithinTheAccuracyOfTheirMesh) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  const ScanProject project = read_scan_project(folder / "data" / "bun.conf");
  const TriangleMesh published = read_mesh(folder / "reconstruction" / "bun_zipper.ply");
  const WatertightResult result = make_watertight(merge_volumetric(project).mesh);
  expect_watertight(result);
  EXPECT_FALSE(result.wrapped);
  const MeshDeviation there = deviation_from_mesh(result.mesh.vertices, published);
  const MeshDeviation back = deviation_from_mesh(published.vertices, result.mesh);
  EXPECT_LE(there.median, 0.035e-3);
  EXPECT_LE(there.p95, 0.14e-3);
  EXPECT_LE(back.median, 0.035e-3);
  EXPECT_LE(back.p95, 0.14e-3);
}

}  // namespace
}  // namespace facula
