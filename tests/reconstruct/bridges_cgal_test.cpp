// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/cgal_bridge.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>
#include <facula/reconstruct/pcl_bridge.hpp>
#include <facula/tests/reconstruct/surfaces.hpp>
#include <facula/tests/support/matchers.hpp>

#include <limits>

#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

namespace facula {
namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;

TEST(PclBridge, GivesPointsBackBitForBit) {
  PointCloud cloud = sphere_points(500, 1.5);
  EXPECT_TRUE(to_pcl(cloud)->is_dense);
  EXPECT_EQ(from_pcl(*to_pcl(cloud)).points, cloud.points);
  cloud.points[7].x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(to_pcl(cloud)->is_dense);
  EXPECT_EQ(to_pcl(cloud)->size(), 500U);
}

TEST(PclBridge, CarriesNormalsBothWays) {
  PointCloud cloud = sphere_points(500, 1.5);
  EXPECT_NE(error_of([&] { to_pcl_with_normals(cloud); }).find("normals"), std::string::npos);
  estimate_normals(cloud);
  const PointCloud back = from_pcl(*to_pcl_with_normals(cloud));
  EXPECT_EQ(back.points, cloud.points);
  EXPECT_EQ(back.normals, cloud.normals);
  EXPECT_TRUE(from_pcl(*to_pcl_with_normals({})).empty());
}

TEST(PclBridge, TakesTheSensorOriginAlong) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  cloud.push_back({1, 2, 3});
  EXPECT_TRUE(from_pcl(cloud).sensor_origin.empty());
  cloud.sensor_origin_ = Eigen::Vector4f(4, 5, 6, 0);
  EXPECT_EQ(from_pcl(cloud).sensor_origin.at(0), Eigen::Vector3f(4, 5, 6));
}

TEST(CgalBridge, GivesAMeshBackWithTheAreaCgalMeasures) {
  const TriangleMesh mesh = mesh_advancing_front(sphere_points(1000, 1.0));
  const auto surface = to_cgal<Point>(mesh);
  EXPECT_NEAR(CGAL::Polygon_mesh_processing::area(surface), mesh_statistics(mesh).area, 1e-9);
  EXPECT_NEAR(CGAL::Polygon_mesh_processing::volume(surface), mesh_statistics(mesh).volume, 1e-9);
  const TriangleMesh back = from_cgal(surface);
  EXPECT_EQ(back.vertices, mesh.vertices);
  EXPECT_EQ(back.triangles.size(), mesh.triangles.size());
  EXPECT_NEAR(mesh_statistics(back).volume, mesh_statistics(mesh).volume, 1e-12);
}

TEST(CgalBridge, SplitsPolygonsAndRefusesWhatIsNoManifold) {
  CGAL::Surface_mesh<Point> square;
  const auto a = square.add_vertex({0, 0, 0});
  const auto b = square.add_vertex({1, 0, 0});
  const auto c = square.add_vertex({1, 1, 0});
  const auto d = square.add_vertex({0, 1, 0});
  square.add_face(a, b, c, d);
  EXPECT_EQ(from_cgal(square).triangles.size(), 2U);
  EXPECT_NEAR(mesh_statistics(from_cgal(square)).area, 1, 1e-12);

  TriangleMesh book;
  book.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
  book.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  EXPECT_NE(error_of([&] { to_cgal<Point>(book); }).find("triangle 1"), std::string::npos);
}

}  // namespace
}  // namespace facula
