// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/mesh/mesh_engines.hpp>
#include <facula/reconstruct/mesh/mesh_method.hpp>
#include <facula/reconstruct/mesh/mesh_verdict.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>
#include <facula/tests/reconstruct/mesh_shapes.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>

#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

PointCloud noisy_sphere(std::size_t count, double sigma) {
  PointCloud cloud = sphere_points(count, 1.0);
  cloud.normals = cloud.points;
  Random random(4);
  for (Eigen::Vector3f& p : cloud.points) p *= float(1 + sigma * random.normal());
  return cloud;
}

/// Largest and mean distance of the vertices from the unit sphere.
std::array<double, 2> distances_to_sphere(const TriangleMesh& mesh) {
  double largest = 0;
  double sum = 0;
  for (const Eigen::Vector3f& v : mesh.vertices) {
    largest = std::max(largest, std::abs(double(v.norm()) - 1));
    sum += std::abs(double(v.norm()) - 1);
  }
  return {largest, sum / double(mesh.vertices.size())};
}

TEST(MeshPoisson, ClosesASphereBetweenItsNoisyPoints) {
  const TriangleMesh mesh = mesh_poisson(noisy_sphere(5000, 0.01), {.spacing = 0.06});
  const MeshVerdict verdict = judge_mesh(mesh);
  EXPECT_TRUE(verdict.watertight()) << verdict.sentence();
  EXPECT_NEAR(*verdict.volume, 4 * M_PI / 3, 0.05 * 4);
  EXPECT_LT(distances_to_sphere(mesh)[1], 0.008) << "nearer than the noise of 0.01";
}

TEST(MeshPoisson, IsTheSameEachTimeAndNeedsNormals) {
  const PointCloud cloud = noisy_sphere(1500, 0.005);
  const TriangleMesh once = mesh_poisson(cloud);
  const TriangleMesh again = mesh_poisson(cloud);
  EXPECT_EQ(once.vertices, again.vertices);
  EXPECT_EQ(once.triangles, again.triangles);
  PointCloud bare = cloud;
  bare.normals.clear();
  EXPECT_NE(error_of([&] { mesh_poisson(bare); }).find("normal"), std::string::npos);
}

TEST(MeshScaleSpace, JoinsNoisyPointsWithoutNormals) {
  PointCloud cloud = noisy_sphere(4000, 0.002);
  cloud.normals.clear();
  const TriangleMesh mesh = mesh_scale_space(cloud);
  const MeshVerdict verdict = judge_mesh(mesh);
  EXPECT_NEAR(verdict.statistics.area, 4 * M_PI, 0.6);
  EXPECT_GT(verdict.statistics.volume, 3.8);
}

TEST(WrapPoints, GivesAClosedManifoldOutsideOfThePoints) {
  const PointCloud cloud = noisy_sphere(3000, 0);
  const TriangleMesh mesh = wrap_points(cloud, {.alpha = 0.3, .offset = 0.03});
  const MeshVerdict verdict = judge_mesh(mesh, cloud.points);
  EXPECT_TRUE(verdict.watertight()) << verdict.sentence();
  EXPECT_GT(*verdict.volume, 4 * M_PI / 3);
  EXPECT_LT(verdict.deviation->max, 0.03 + 1e-6) << "no farther than the offset";
  EXPECT_GT(verdict.deviation->median, 0.005);
}

TEST(Engines, RefuseWhatHoldsNoSurfaceInASentence) {
  PointCloud line;
  for (int i = 0; i < 50; ++i) line.points.emplace_back(0.1F * float(i), 0, 0);
  line.normals.assign(50, Eigen::Vector3f(0, 0, 1));
  PointCloud spot;
  spot.points.assign(50, Eigen::Vector3f(1, 2, 3));
  spot.normals.assign(50, Eigen::Vector3f(0, 0, 1));
  PointCloud nan = spot;
  for (auto& p : nan.points) p.x() = std::numeric_limits<float>::quiet_NaN();
  for (const PointCloud& cloud : {PointCloud{}, line, spot, nan}) {
    EXPECT_NE(error_of([&] { mesh_poisson(cloud); }), "");
    EXPECT_NE(error_of([&] { mesh_scale_space(cloud); }), "");
    EXPECT_NE(error_of([&] { wrap_points(cloud); }), "");
  }
}

TEST(Engines, TakeDuplicatesAndPlanes) {
  PointCloud plane;
  Random random(1);
  add_patch(plane, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 800, 0, random);
  append(plane, plane);
  EXPECT_TRUE(judge_mesh(wrap_points(plane)).watertight());
  EXPECT_NEAR(mesh_statistics(mesh_scale_space(plane)).area, 1, 0.15);
  plane.normals.assign(plane.size(), Eigen::Vector3f(0, 0, 1));
  EXPECT_NE(error_of([&] { mesh_poisson(plane); }).find("lie on one plane"), std::string::npos);
}

TEST(Engines, RefusePointsThatNoScannerReaches) {
  PointCloud far = sphere_points(500, 1.0);
  far.normals = far.points;
  for (Eigen::Vector3f& p : far.points) p *= 1e31F;
  for (const std::string& sentence : {error_of([&] { mesh_poisson(far); }),
                                      error_of([&] { mesh_scale_space(far); }),
                                      error_of([&] { mesh_advancing_front(far); }),
                                      error_of([&] { wrap_points(far); })}) {
    EXPECT_NE(sentence.find("no scanner reaches"), std::string::npos) << sentence;
  }
}

ScanProject project_of(PointCloud cloud) {
  ScanProject project;
  project.scans.emplace_back();
  project.scans.front().cloud = std::move(cloud);
  return project;
}

TEST(ChooseMethod, GoesByWhatTheScansHold) {
  PointCloud all_around = noisy_sphere(1000, 0);
  EXPECT_EQ(choose_method(project_of(all_around)).method, MeshMethod::kPoisson);
  PointCloud one_side = all_around;
  for (Eigen::Vector3f& n : one_side.normals) n = Eigen::Vector3f(0, 0, 1);
  EXPECT_EQ(choose_method(project_of(one_side)).method, MeshMethod::kAdvancingFront);
  PointCloud bare = all_around;
  bare.normals.clear();
  const MethodChoice choice = choose_method(project_of(bare));
  EXPECT_EQ(choice.method, MeshMethod::kScaleSpace);
  EXPECT_NE(choice.reason.find("neither"), std::string::npos);
  ScanProject scanned = project_of(bare);
  scanned.scans.front().cloud.sensor_origin.assign(1000, Eigen::Vector3f(0, 0, 5));
  scanned.scans.front().grid = {1, 1000, std::vector<std::int32_t>(1000, -1)};
  EXPECT_EQ(choose_method(scanned).method, MeshMethod::kVolumetric);
  EXPECT_NE(error_of([] { choose_method({}); }), "");
}

TEST(ChooseMethod, NamesEveryMethod) {
  for (const MeshMethod method : {MeshMethod::kVolumetric,
                                  MeshMethod::kPoisson,
                                  MeshMethod::kAdvancingFront,
                                  MeshMethod::kScaleSpace,
                                  MeshMethod::kAlphaWrap}) {
    EXPECT_EQ(mesh_method(to_string(method)), method);
  }
  EXPECT_NE(error_of([] { mesh_method("delaunay"); }).find("poisson"), std::string::npos);
}

TEST(MeshScans, MeshesASphereByEveryMethodThatNeedsNoGrid) {
  const ScanProject project = project_of(noisy_sphere(3000, 0.001));
  for (const MeshMethod method : {MeshMethod::kPoisson,
                                  MeshMethod::kAdvancingFront,
                                  MeshMethod::kScaleSpace,
                                  MeshMethod::kAlphaWrap}) {
    const MeshedScans meshed = mesh_scans(project, method);
    EXPECT_NEAR(mesh_statistics(meshed.mesh).volume, 4 * M_PI / 3, 0.6) << to_string(method);
  }
}

}  // namespace
}  // namespace facula
