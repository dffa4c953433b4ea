// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/mesh/meshing.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

namespace facula {
namespace {

double longest_edge(const TriangleMesh& mesh) {
  double longest = 0;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3f edge = mesh.vertices[t[i]] - mesh.vertices[t[(i + 1) % 3]];
      longest = std::max(longest, double(edge.norm()));
    }
  }
  return longest;
}

Eigen::Vector3f normal_of(const TriangleMesh& mesh, const TriangleMesh::Triangle& t) {
  const Eigen::Vector3f& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).normalized();
}

TEST(MeshAdvancingFront, ClosesASphere) {
  const TriangleMesh mesh = mesh_advancing_front(sphere_points(4000, 1.0));
  const MeshStatistics statistics = mesh_statistics(mesh);
  EXPECT_EQ(statistics.vertices, 4000U);
  EXPECT_TRUE(statistics.watertight);
  EXPECT_EQ(statistics.triangles, 2U * 4000 - 4);  // Euler's formula for a closed surface
  EXPECT_NEAR(statistics.area, 4 * M_PI, 0.002 * 4 * M_PI);
  EXPECT_NEAR(statistics.volume, 4 * M_PI / 3, 0.003 * 4 * M_PI / 3);
}

TEST(MeshAdvancingFront, TurnsTrianglesTowardsTheSensor) {
  PointCloud outside = sphere_points(2000, 1.0);
  for (const Eigen::Vector3f& p : outside.points) outside.sensor_origin.push_back(4 * p);
  PointCloud inside = outside;
  for (Eigen::Vector3f& origin : inside.sensor_origin) origin.setZero();
  EXPECT_GT(mesh_statistics(mesh_advancing_front(outside)).volume, 4);
  EXPECT_LT(mesh_statistics(mesh_advancing_front(inside)).volume, -4);
}

TEST(MeshAdvancingFront, TurnsEveryPieceOfSeveral) {
  PointCloud cloud;
  for (int i = 0; i < 3; ++i) {
    for (const Eigen::Vector3f& p : sphere_points(800, 1.0).points) {
      cloud.points.push_back(p + Eigen::Vector3f(5 * float(i), 0, 0));
      cloud.normals.push_back(p);
    }
  }
  const TriangleMesh mesh = mesh_advancing_front(cloud);
  const MeshStatistics statistics = mesh_statistics(mesh);
  EXPECT_EQ(statistics.components, 3U);
  for (const auto& t : mesh.triangles) {
    EXPECT_GT(normal_of(mesh, t).dot(mesh.normals[t[0]]), 0.9F);
  }
}

TEST(MeshAdvancingFront, LeavesNoEdgeLongerThanAllowed) {
  PointCloud cloud;
  Random random(3);
  add_patch(cloud, {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, 3000, 0, random);
  add_patch(cloud, {{1.15, 0, 1}, {1, 0, 0}, {0, 1, 0}}, 3000, 0, random);
  const TriangleMesh mesh = mesh_advancing_front(cloud, {.max_edge = 0.1});
  EXPECT_LE(longest_edge(mesh), 0.1 + 1e-6);
  EXPECT_EQ(mesh_statistics(mesh).components, 2U);
  EXPECT_NEAR(mesh_statistics(mesh).area, 2, 0.1);
}

TEST(MeshAdvancingFront, BearsBadPointsAndRefusesTooFew) {
  PointCloud cloud = sphere_points(500, 1.0);
  cloud.points.push_back(cloud.points.front());
  cloud.points.push_back(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_TRUE(mesh_statistics(mesh_advancing_front(cloud)).watertight);
  EXPECT_NE(error_of([] { mesh_advancing_front({}); }).find("at least 4"), std::string::npos);
  PointCloud spot;
  spot.points.assign(100, Eigen::Vector3f(1, 1, 1));
  EXPECT_NE(error_of([&] { mesh_advancing_front(spot); }).find("has 1 that"), std::string::npos);
  PointCloud line;
  for (int i = 0; i < 100; ++i) line.points.emplace_back(0.01F * static_cast<float>(i), 1, 1);
  EXPECT_NE(error_of([&] { mesh_advancing_front(line); }).find("no surface"), std::string::npos);
}

/// A wall at x = `x_of(row, col)` seen from an eye beside the origin.
template <typename Depth>
PolarScan wall_scan(int rows, int cols, const Depth& x_of) {
  PolarScan scan = PolarScan::empty(rows, cols);
  for (int col = 0; col < cols; ++col) {
    scan.sensor_origin[std::size_t(col)] = {0, 0.02, 0.01};
    for (int row = 0; row < rows; ++row) {
      const double x = x_of(row, col);
      const Eigen::Vector3d p(x, 0.005 * (col - 0.5 * cols) * x, 0.005 * (row - 0.5 * rows) * x);
      scan.set(scan.index(row, col), p, 0.5F, 0.001F);
    }
  }
  return scan;
}

TEST(MeshGrid, CoversAFlatWallOnceTurnedToTheSensor) {
  const TriangleMesh mesh = mesh_grid(wall_scan(50, 80, [](int, int) { return 2.0; }));
  const MeshStatistics statistics = mesh_statistics(mesh);
  EXPECT_EQ(statistics.triangles, 2U * 49 * 79);
  EXPECT_EQ(statistics.components, 1U);
  EXPECT_NEAR(statistics.area, 0.49 * 0.79, 1e-5);
  for (const auto& t : mesh.triangles) EXPECT_LT(normal_of(mesh, t).x(), -0.999F);
}

TEST(MeshGrid, PutsNoTriangleAcrossADepthEdge) {
  const auto step = [](int, int col) { return col < 40 ? 1.0 : 1.5; };
  const TriangleMesh mesh = mesh_grid(wall_scan(50, 80, step));
  EXPECT_EQ(mesh.triangles.size(), 2U * 49 * 78);
  EXPECT_EQ(mesh_statistics(mesh).components, 2U);
  for (const auto& t : mesh.triangles) {
    EXPECT_NEAR(mesh.vertices[t[0]].x(), mesh.vertices[t[1]].x(), 1e-4);
    EXPECT_NEAR(mesh.vertices[t[0]].x(), mesh.vertices[t[2]].x(), 1e-4);
  }
}

TEST(MeshGrid, LeavesOneTriangleWhereACornerIsMissing) {
  PolarScan scan = wall_scan(2, 2, [](int, int) { return 2.0; });
  EXPECT_EQ(mesh_grid(scan).triangles.size(), 2U);
  scan.clear(scan.index(0, 1));
  EXPECT_EQ(mesh_grid(scan).triangles.size(), 1U);
  scan.clear(scan.index(1, 0));
  EXPECT_TRUE(mesh_grid(scan).empty());
  EXPECT_TRUE(mesh_grid(PolarScan::empty(0, 0)).empty());
}

TEST(MeshGrid, JoinsTheLastColumnToTheFirstOfAFullTurn) {
  PolarScan scan = PolarScan::empty(10, 72);
  for (int col = 0; col < 72; ++col) {
    const double yaw = 2 * M_PI * col / 72;
    for (int row = 0; row < 10; ++row) {
      const Eigen::Vector3d p(0.3 * std::cos(yaw), 0.3 * std::sin(yaw), 0.02 * row);
      scan.set(scan.index(row, col), p, 0.5F, 0.001F);
    }
  }
  const MeshStatistics open = mesh_statistics(mesh_grid(scan));
  const MeshStatistics closed = mesh_statistics(mesh_grid(scan, {.close_turn = true}));
  EXPECT_EQ(open.triangles, 2U * 9 * 71);
  EXPECT_EQ(closed.triangles, 2U * 9 * 72);
  EXPECT_EQ(closed.boundary_edges, 2U * 72);  // the two rims of the tube
}

TEST(MeshGrid, RefusesOptionsOutOfRange) {
  EXPECT_NE(error_of([] { mesh_grid(PolarScan::empty(2, 2), {.max_edge = 0}); }), "");
  EXPECT_NE(error_of([] { mesh_grid(PolarScan::empty(2, 2), {.edge_ratio = -1}); }), "");
}

TriangleMesh unit_square() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(DistancesToMesh, AreThoseToFaceEdgeAndCorner) {
  const auto distances = distances_to_mesh(
      {{0.3F, 0.2F, 2}, {0.5F, -3, 4}, {-1, -2, -2}, {0.7F, 0.7F, 0}}, unit_square());
  ASSERT_EQ(distances.size(), 4U);
  EXPECT_NEAR(distances[0], 2, 1e-12);
  EXPECT_NEAR(distances[1], 5, 1e-12);
  EXPECT_NEAR(distances[2], 3, 1e-12);
  EXPECT_NEAR(distances[3], 0, 1e-12);
}

TEST(DistancesToMesh, AreNearThoseToTheSphereItApproximates) {
  const TriangleMesh mesh = mesh_advancing_front(sphere_points(20000, 1.0));
  std::vector<Eigen::Vector3f> points;
  Random random(6);
  for (int i = 0; i < 2000; ++i) {
    points.emplace_back(float(random.normal()), float(random.normal()), float(random.normal()));
  }
  const auto distances = distances_to_mesh(points, mesh);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(distances[i], std::abs(double(points[i].norm()) - 1), 4e-4);
  }
}

TEST(DistancesToMesh, PassOverBadPointsAndTrianglesWithoutArea) {
  TriangleMesh mesh = unit_square();
  mesh.triangles.push_back({1, 1, 2});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto distances = distances_to_mesh({{nan, 0, 0}, {0.5F, 0.5F, 1}}, mesh);
  EXPECT_TRUE(std::isnan(distances[0]));
  EXPECT_NEAR(distances[1], 1, 1e-12);
  mesh.triangles = {{1, 1, 2}};
  EXPECT_NE(error_of([&] { distances_to_mesh({{0, 0, 0}}, mesh); }), "");
  EXPECT_NE(error_of([] { distances_to_mesh({{0, 0, 0}}, {}); }), "");
}

}  // namespace
}  // namespace facula
