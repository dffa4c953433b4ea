// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/meshes.hpp>

#include <cmath>
#include <numbers>

namespace facula {
namespace {

/// Rings of a sphere about the origin with a fan at each pole.
TriangleMesh sphere(double radius, std::uint32_t rings, std::uint32_t sectors) {
  TriangleMesh mesh;
  const auto add = [&](double pitch, double yaw) {
    mesh.vertices.emplace_back((radius * Eigen::Vector3d(std::cos(pitch) * std::cos(yaw),
                                                         std::cos(pitch) * std::sin(yaw),
                                                         std::sin(pitch)))
                                   .cast<float>());
  };
  const double pi = std::numbers::pi;
  for (std::uint32_t r = 1; r < rings; ++r) {
    for (std::uint32_t s = 0; s < sectors; ++s) {
      add(-pi / 2 + pi * r / rings, 2 * pi * s / sectors);
    }
  }
  add(-pi / 2, 0);
  add(pi / 2, 0);
  const std::uint32_t south = (rings - 1) * sectors;
  const std::uint32_t top = south - sectors;
  for (std::uint32_t s = 0; s < sectors; ++s) {
    const std::uint32_t next = (s + 1) % sectors;
    mesh.triangles.push_back({south, next, s});
    mesh.triangles.push_back({south + 1, top + s, top + next});
    for (std::uint32_t low = 0; low < top; low += sectors) {
      mesh.triangles.push_back({low + s, low + next, low + sectors + s});
      mesh.triangles.push_back({low + next, low + sectors + next, low + sectors + s});
    }
  }
  return mesh;
}

TEST(TriangleMesh, MeasuresABox) {
  const MeshStatistics s = mesh_statistics(box_mesh(1, 2, 3));
  EXPECT_EQ(s.vertices, 8U);
  EXPECT_EQ(s.triangles, 12U);
  EXPECT_DOUBLE_EQ(s.area, 22);
  EXPECT_DOUBLE_EQ(s.volume, 6);
  EXPECT_TRUE(s.watertight);
  EXPECT_EQ(s.components, 1U);
}

TEST(TriangleMesh, MeasuresATetrahedron) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const MeshStatistics s = mesh_statistics(mesh);
  EXPECT_NEAR(s.volume, 1.0 / 6, 1e-15);
  EXPECT_NEAR(s.area, 1.5 + std::sqrt(3.0) / 2, 1e-12);
  EXPECT_TRUE(s.watertight);
}

TEST(TriangleMesh, CountsTheRimOfAnOpenBox) {
  TriangleMesh open = box_mesh(1, 1, 1);
  open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 2);
  const MeshStatistics s = mesh_statistics(open);
  EXPECT_EQ(s.boundary_edges, 4U);
  EXPECT_FALSE(s.watertight);
  EXPECT_DOUBLE_EQ(s.area, 5);
}

TEST(TriangleMesh, FindsTheEdgeOfAFin) {
  TriangleMesh fin = box_mesh(1, 1, 1);
  fin.vertices.emplace_back(2, 2, 2);
  fin.triangles.push_back({0, 1, 8});
  const MeshStatistics s = mesh_statistics(fin);
  EXPECT_EQ(s.non_manifold_edges, 1U);
  EXPECT_EQ(s.boundary_edges, 2U);
  EXPECT_FALSE(s.watertight);
  EXPECT_EQ(s.components, 1U);
}

TEST(TriangleMesh, CountsPiecesThatShareNoEdge) {
  TriangleMesh two = box_mesh(1, 1, 1);
  const TriangleMesh other = box_mesh(2, 2, 2);
  for (const auto& v : other.vertices) two.vertices.emplace_back(v + Eigen::Vector3f(9, 0, 0));
  for (const auto& t : other.triangles) two.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  const MeshStatistics s = mesh_statistics(two);
  EXPECT_EQ(s.components, 2U);
  EXPECT_NEAR(s.volume, 9, 1e-5);
}

TEST(TriangleMesh, NearsTheVolumeOfASphere) {
  const MeshStatistics s = mesh_statistics(sphere(0.5, 200, 400));
  EXPECT_TRUE(s.watertight);
  EXPECT_EQ(s.vertices + s.triangles - s.triangles * 3 / 2, 2U) << "Euler's formula";
  const double volume = 4.0 / 3 * std::numbers::pi * 0.125;
  EXPECT_LT(s.volume, volume);  // an inscribed polyhedron
  EXPECT_NEAR(s.volume, volume, 2e-4 * volume);
  EXPECT_NEAR(s.area, std::numbers::pi, 2e-4 * std::numbers::pi);
}

TEST(TriangleMesh, KeepsItsVolumeWhenMoved) {
  RigidTransform pose;
  pose.rotation = Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized());
  pose.translation = {4, 5, 6};
  EXPECT_NEAR(mesh_statistics(transformed(box_mesh(1, 2, 3), pose)).volume, 6, 1e-4);
}

TEST(TriangleMesh, CheckNamesTheVertexThatIsNotThere) {
  TriangleMesh mesh = box_mesh(1, 1, 1);
  mesh.triangles.push_back({0, 1, 8});
  EXPECT_NE(error_of([&] { mesh.check(); }).find("vertex 8"), std::string::npos);
  mesh = box_mesh(1, 1, 1);
  mesh.colors.resize(3);
  EXPECT_THROW(mesh.check(), Error);
}

TEST(TriangleMesh, WithoutTrianglesIsNotWatertight) {
  EXPECT_FALSE(mesh_statistics(TriangleMesh()).watertight);
}

}  // namespace
}  // namespace facula
