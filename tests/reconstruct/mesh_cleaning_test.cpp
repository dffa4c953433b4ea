// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/mesh/mesh_cleaning.hpp>
#include <facula/reconstruct/mesh/mesh_color.hpp>
#include <facula/reconstruct/mesh/mesh_verdict.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>
#include <facula/tests/reconstruct/mesh_shapes.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

TriangleMesh sheet(std::uint32_t cells) {
  return grid_surface(
      cells + 1, cells + 1, [](double u, double v) { return Eigen::Vector3d(v, u, 0); });
}

TEST(RepairMesh, LeavesASoundMeshAsItIs) {
  const TriangleMesh torus_mesh = torus(1, 0.3, 24, 12);
  RepairCounts counts;
  const TriangleMesh mesh = repaired(torus_mesh, &counts);
  EXPECT_EQ(mesh.triangles, torus_mesh.triangles);
  EXPECT_EQ(mesh.vertices, torus_mesh.vertices);
  EXPECT_EQ(counts.bad_triangles + counts.double_triangles + counts.crowded_triangles, 0U);
}

TEST(RepairMesh, MakesAManifoldOfEverythingThatCanGoWrong) {
  TriangleMesh mesh = sphere_mesh(1, 3);
  const auto vertices = std::uint32_t(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 7) {
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);  // turned
  }
  mesh.triangles.push_back(mesh.triangles[5]);  // double
  mesh.triangles.push_back({0, 0, 1});          // no area
  mesh.vertices.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0, 0);
  mesh.triangles.push_back({0, 1, vertices});  // not finite
  mesh.vertices.emplace_back(0, 0, 1.01F);
  const auto [a, b, c] = mesh.triangles[100];
  mesh.triangles.push_back({a, b, vertices + 1});  // a fin: an edge of three triangles
  mesh.triangles.push_back({a, b, vertices + 1});
  RepairCounts counts;
  const TriangleMesh result = repaired(mesh, &counts);
  EXPECT_EQ(counts.bad_triangles, 2U);
  EXPECT_EQ(counts.double_triangles, 2U);
  EXPECT_GE(counts.turned_triangles, 70U);
  const MeshVerdict verdict = judge_mesh(result);
  EXPECT_TRUE(verdict.manifold) << verdict.sentence();
  EXPECT_NEAR(verdict.statistics.area, 4 * M_PI, 0.3);
  EXPECT_GT(verdict.statistics.volume, 4.0);
}

TEST(RepairMesh, PartsPiecesThatTouchAtAVertex) {
  TriangleMesh mesh = box_mesh(1, 1, 1);
  add_mesh(mesh, box_mesh(1, 1, 1), {1, 1, 1});
  for (auto& t : mesh.triangles) {
    for (auto& v : t) v = v == 8 ? 7 : v;
  }
  RepairCounts counts;
  const TriangleMesh parted = repaired(mesh, &counts);
  EXPECT_EQ(counts.split_vertices, 1U);
  EXPECT_EQ(parted.vertices.size(), 16U);
  const MeshVerdict verdict = judge_mesh(parted);
  EXPECT_TRUE(verdict.manifold);
  EXPECT_EQ(verdict.self_intersections, 0U) << "they still touch";
  EXPECT_NEAR(*verdict.volume, 2, 0.02);
}

/// A chessboard's black squares touch at their corners only, in one plane.
TEST(RepairMesh, PartsSheetsThatTouchAtTheirRims) {
  TriangleMesh board =
      grid_surface(9, 9, [](double u, double v) { return Eigen::Vector3d(8 * u, 8 * v, 0); });
  std::erase_if(board.triangles, [&](const TriangleMesh::Triangle& t) {
    Eigen::Vector3f centre = Eigen::Vector3f::Zero();
    for (const auto v : t) centre += board.vertices[v] / 3;
    return (int(centre.x()) + int(centre.y())) % 2 == 1;
  });
  RepairCounts counts;
  const TriangleMesh parted = repaired(board, &counts);
  EXPECT_EQ(counts.split_vertices, 49U) << "the inner corners";
  const MeshVerdict verdict = judge_mesh(parted);
  EXPECT_TRUE(verdict.manifold);
  EXPECT_EQ(verdict.statistics.components, 32U);
  EXPECT_EQ(verdict.self_intersections, 0U);
}

TEST(RepairMesh, OfNothingIsNothing) {
  EXPECT_TRUE(repaired({}).empty());
  TriangleMesh bad = box_mesh(1, 1, 1);
  bad.triangles[0][0] = 50;
  EXPECT_NE(error_of([&] { repaired(bad); }).find("50"), std::string::npos);
}

TEST(Islands, GoBySizeOrButForTheLargest) {
  TriangleMesh mesh = sphere_mesh(1, 2);
  add_mesh(mesh, box_mesh(0.1F, 0.1F, 0.1F), {3, 0, 0});
  add_mesh(mesh, box_mesh(0.5F, 0.5F, 0.5F), {5, 0, 0});
  std::size_t removed = 0;
  const TriangleMesh some = without_islands(mesh, {.min_diameter = 0.2}, &removed);
  EXPECT_EQ(removed, 1U);
  EXPECT_EQ(some.triangles.size(), 128U + 12);
  EXPECT_EQ(some.vertices.size(), 66U + 8);
  const TriangleMesh one = without_islands(mesh, {.keep_largest = true}, &removed);
  EXPECT_EQ(removed, 2U);
  EXPECT_EQ(one.triangles.size(), 128U);
  EXPECT_NE(error_of([&] { without_islands(mesh, {.min_diameter = -1}); }), "");
}

TEST(FillHoles, ClosesThoseUpToTheSizeAskedFor) {
  // Two holes in a sheet of 20 x 20 cells: one cell across, and six cells.
  const TriangleMesh holed = without(sheet(20), [](const Eigen::Vector3f& c) {
    const bool small = c.x() > 0.2F && c.x() < 0.25F && c.y() > 0.2F && c.y() < 0.25F;
    const bool large = c.x() > 0.5F && c.x() < 0.8F && c.y() > 0.5F && c.y() < 0.8F;
    return small || large;
  });
  EXPECT_NEAR(mesh_statistics(holed).area, 1 - 0.0025 - 0.09, 1e-5);
  std::size_t filled = 0;
  const TriangleMesh one = fill_holes(holed, 0.1, &filled);
  EXPECT_EQ(filled, 1U);
  EXPECT_NEAR(mesh_statistics(one).area, 1 - 0.09, 1e-5);
  const TriangleMesh both = fill_holes(holed, 0.5, &filled);
  EXPECT_EQ(filled, 2U);
  EXPECT_NEAR(mesh_statistics(both).area, 1, 1e-5);
  const MeshVerdict verdict = judge_mesh(both);
  EXPECT_EQ(verdict.loops.size(), 1U) << "the rim of the sheet is longer than 0.5 m across";
  EXPECT_TRUE(verdict.manifold);
  EXPECT_EQ(verdict.self_intersections, 0U);
  EXPECT_EQ(verdict.statistics.non_manifold_edges, 0U);
}

TEST(FillHoles, ContinuesTheRoundnessOfASphere) {
  const TriangleMesh sphere = sphere_mesh(1, 5);
  const TriangleMesh holed = without(sphere, [](const Eigen::Vector3f& c) { return c.z() > 0.9F; });
  const MeshVerdict verdict = judge_mesh(fill_holes(holed, 2));
  EXPECT_TRUE(verdict.watertight()) << verdict.sentence();
  // A flat lid would lose the cap of height 0.1: pi h^2 (3 - h) / 3 = 0.0304 m^3.
  EXPECT_LT(std::abs(*verdict.volume - judge_mesh(sphere).volume.value()), 0.010);
}

TEST(Remesh, EvensOutTheEdgesOnTheSameSurface) {
  const TriangleMesh sphere = sphere_mesh(1, 4);
  const TriangleMesh mesh = remeshed(sphere, 0.1);
  const MeshVerdict verdict = judge_mesh(mesh, sphere.vertices);
  EXPECT_TRUE(verdict.watertight());
  // An even mesh has 4 pi / (sqrt(3) / 4 0.01) triangles.
  EXPECT_NEAR(double(mesh.triangles.size()), 2902, 600);
  EXPECT_LT(verdict.deviation->max, 0.006);
  EXPECT_NE(error_of([&] { remeshed(sphere, 0); }), "");
  EXPECT_NE(error_of([&] { remeshed(sphere, 1e-9); }).find("longer edge"), std::string::npos);
}

TEST(Simplify, StopsAtTheNumberOfTriangles) {
  const TriangleMesh mesh = simplified(sphere_mesh(1, 5), {.triangles = 1000});
  EXPECT_NEAR(double(mesh.triangles.size()), 1000, 2);
  const MeshVerdict verdict = judge_mesh(mesh);
  EXPECT_TRUE(verdict.watertight());
  EXPECT_NEAR(*verdict.volume, 4 * M_PI / 3, 0.03);
}

TEST(Simplify, KeepsTheErrorAskedForAndFlatThingsExact) {
  const TriangleMesh sphere = sphere_mesh(1, 5);
  for (const double error : {0.01, 0.002}) {
    const TriangleMesh mesh = simplified(sphere, {.max_error = error});
    EXPECT_LE(deviation_from_mesh(sphere.vertices, mesh).max, error);
    EXPECT_LT(mesh.triangles.size(), sphere.triangles.size() / (error > 0.005 ? 2 : 1)) << error;
  }
  const TriangleMesh flat = simplified(sheet(40), {.max_error = 1e-5});
  EXPECT_LT(flat.triangles.size(), 400U);
  EXPECT_NEAR(mesh_statistics(flat).area, 1, 1e-4);
  EXPECT_NE(error_of([] { simplified(box_mesh(1, 1, 1), {}); }), "");
  EXPECT_NE(error_of([] { simplified({}, {.triangles = 10}); }), "");
}

TEST(Smooth, DampsNoiseAndKeepsTheVolume) {
  TriangleMesh noisy = sphere_mesh(1, 5);
  Random random(5);
  for (Eigen::Vector3f& v : noisy.vertices) v *= float(1 + 0.005 * random.normal());
  const auto rms = [](const TriangleMesh& mesh) {
    double sum = 0;
    for (const Eigen::Vector3f& v : mesh.vertices) sum += std::pow(double(v.norm()) - 1, 2);
    return std::sqrt(sum / double(mesh.vertices.size()));
  };
  const TriangleMesh smooth = smoothed(noisy, 10);
  EXPECT_LT(rms(smooth), 0.45 * rms(noisy));
  EXPECT_NEAR(mesh_statistics(smooth).volume, 4 * M_PI / 3, 0.015);
  EXPECT_EQ(smoothed(noisy, 10, 1).vertices, smoothed(noisy, 10, 2).vertices);
  const TriangleMesh rim = smoothed(sheet(10), 20);
  EXPECT_NEAR(mesh_statistics(rim).area, 1, 1e-5) << "the rim stays";
}

TEST(ColorMesh, TakesTheColourOfTheNearestPoints) {
  PointCloud cloud;
  Random random(2);
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3f p(float(random.uniform()), float(random.uniform()), 0);
    cloud.points.push_back(p);
    cloud.colors.push_back(p.x() < 0.5F ? Color{200, 0, 0} : Color{0, 0, 100});
    cloud.intensity.push_back(0.5F);
  }
  cloud.points.back().x() = std::numeric_limits<float>::quiet_NaN();
  TriangleMesh mesh = sheet(10);
  color_mesh(mesh, cloud);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (mesh.vertices[v].x() < 0.45F) {
      EXPECT_EQ(mesh.colors[v], (Color{200, 0, 0}));
    } else if (mesh.vertices[v].x() > 0.55F) {
      EXPECT_EQ(mesh.colors[v], (Color{0, 0, 100}));
    }
  }
  cloud.colors.clear();
  color_mesh(mesh, cloud);
  EXPECT_EQ(mesh.colors.front(), (Color{128, 128, 128}));
  EXPECT_NE(error_of([&] { color_mesh(mesh, PointCloud{}); }).find("neither"), std::string::npos);
}

}  // namespace
}  // namespace facula
