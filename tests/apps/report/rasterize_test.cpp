// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/mesh_views.hpp>
#include <facula/apps/report/rasterize.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace facula {
namespace {

/// A sphere of latitude and longitude, counter-clockwise seen from outside.
TriangleMesh sphere(double radius, int steps, const Eigen::Vector3d& center = {0, 0, 0}) {
  TriangleMesh mesh;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; j < 2 * steps; ++j) {
      const double theta = M_PI * i / steps;
      const double phi = M_PI * j / steps;
      const Eigen::Vector3d direction(
          std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      mesh.vertices.emplace_back((center + radius * direction).cast<float>());
    }
  }
  const auto id = [&](int i, int j) {
    return static_cast<std::uint32_t>(i * 2 * steps + j % (2 * steps));
  };
  for (int i = 0; i < steps; ++i) {
    for (int j = 0; j < 2 * steps; ++j) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  }
  return mesh;
}

/// A square of side 2 at height z, seen from above with its front.
TriangleMesh square(float z) {
  TriangleMesh mesh;
  mesh.vertices = {{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

void add(TriangleMesh& mesh, const TriangleMesh& more) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const TriangleMesh::Triangle& t : more.triangles) {
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
}

RasterView from_above(double pixels_per_metre, int side) {
  return {top_view(), Eigen::Vector3d::Zero(), pixels_per_metre, side, side};
}

TEST(Rasterize, SphereHasTheSilhouetteOfACircleFromEverySide) {
  const TriangleMesh mesh = sphere(0.5, 90);
  for (const ViewDirection& view : {front_view(), side_view(), top_view(), oblique_view()}) {
    const Raster raster = rasterize(mesh, {view, Eigen::Vector3d::Zero(), 400, 500, 500});
    const double area = static_cast<double>(raster.covered()) / (400.0 * 400.0);
    EXPECT_NEAR(area, M_PI * 0.25, 0.01 * M_PI * 0.25) << view.name;
  }
}

TEST(Rasterize, SphereHasItsHeightAndNormalInEveryPixel) {
  const Raster raster = rasterize(sphere(1, 120), from_above(100, 201));
  for (const int offset : {0, 30, 60}) {
    const std::size_t pixel = static_cast<std::size_t>(100 - offset) * 201 + 100 + offset / 2;
    const double x = offset / 200.0;  // the offsets are even
    const double y = offset / 100.0;
    const double z = std::sqrt(1 - x * x - y * y);
    EXPECT_NEAR(raster.height[pixel], z, 1e-3);
    EXPECT_TRUE(is_near_point(raster.normal[pixel].cast<double>(), {x, y, z}, 0.02));
    EXPECT_EQ(raster.back[pixel], 0);
  }
}

TEST(Rasterize, HidesWhatLiesBehind) {
  for (const bool far_first : {true, false}) {
    TriangleMesh mesh = square(far_first ? 0.0F : 1.0F);
    add(mesh, square(far_first ? 1.0F : 0.0F));
    const Raster raster = rasterize(mesh, from_above(20, 60));
    ASSERT_GT(raster.covered(), 1500U);
    for (std::size_t i = 0; i < raster.triangle.size(); ++i) {
      if (raster.triangle[i] == Raster::kNothing) continue;
      EXPECT_EQ(raster.height[i], 1.0F);
    }
  }
}

TEST(Rasterize, CoversEveryPixelOfAClosedSurfaceAndNoOther) {
  const Raster raster = rasterize(square(0), from_above(20, 60));
  // Pixel centres at whole numbers, the square from 9.5 to 49.5.
  EXPECT_EQ(raster.covered(), 1600U);
}

TEST(Rasterize, TellsBacksFromFrontsAndLeavesThemOutWhenAsked) {
  TriangleMesh mesh = square(0);
  for (TriangleMesh::Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  const Raster shown = rasterize(mesh, from_above(20, 60));
  EXPECT_EQ(shown.covered(), 1600U);
  EXPECT_EQ(shown.back[30 * 60 + 30], 1);
  EXPECT_EQ(rasterize(mesh, from_above(20, 60), {.hide_backs = true}).covered(), 0U);
}

TEST(Rasterize, KeepsSharpEdgesSharp) {
  // A roof with one shared ridge of 90 degrees: no blending over it, but over a blunt one.
  TriangleMesh roof;
  roof.vertices = {{-1, -1, -1}, {-1, 1, -1}, {0, 1, 0}, {0, -1, 0}, {1, -1, -1}, {1, 1, -1}};
  roof.triangles = {{0, 3, 2}, {0, 2, 1}, {3, 4, 5}, {3, 5, 2}};
  const std::size_t beside_ridge = 30 * 60 + 30;
  const float slope = std::sqrt(0.5F);
  const Raster sharp = rasterize(roof, from_above(20, 60));
  EXPECT_NEAR(sharp.normal[beside_ridge].x(), slope, 1e-5);
  const Raster blended = rasterize(roof, from_above(20, 60), {.crease_angle = 1.2});
  EXPECT_LT(blended.normal[beside_ridge].x(), 0.2F);
}

TEST(Rasterize, IsTheSameForEveryNumberOfThreads) {
  const TriangleMesh mesh = sphere(0.5, 60);
  const RasterView view{oblique_view(), Eigen::Vector3d::Zero(), 300, 333, 301};
  const Raster one = rasterize(mesh, view, {.num_threads = 1});
  const Raster many = rasterize(mesh, view, {.num_threads = 7});
  EXPECT_EQ(one.triangle, many.triangle);
  EXPECT_EQ(one.normal, many.normal);
}

TEST(Rasterize, LeavesOutTrianglesItCannotDraw) {
  TriangleMesh mesh = square(0);
  const float bad = std::numeric_limits<float>::quiet_NaN();
  mesh.vertices.push_back({bad, 0, 0});
  mesh.vertices.push_back({std::numeric_limits<float>::infinity(), 0, 0});
  mesh.vertices.push_back({1e30F, 1e30F, 1e30F});
  mesh.triangles.push_back({0, 1, 4});
  mesh.triangles.push_back({0, 1, 5});
  mesh.triangles.push_back({1, 1, 2});
  mesh.triangles.push_back({0, 1, 1});
  EXPECT_EQ(rasterize(mesh, from_above(20, 60)).covered(), 1600U);
  mesh.triangles.push_back({0, 2, 6});  // enormous: cut at the border
  EXPECT_EQ(rasterize(mesh, from_above(20, 60)).triangle.size(), 3600U);
}

TEST(Rasterize, RefusesMeshesAndViewsThatDoNotFit) {
  TriangleMesh mesh = square(0);
  mesh.triangles.push_back({0, 1, 99});
  EXPECT_FALSE(error_of([&] { rasterize(mesh, from_above(20, 60)); }).empty());
  EXPECT_FALSE(error_of([&] { rasterize(square(0), from_above(0, 60)); }).empty());
  EXPECT_FALSE(error_of([&] { rasterize(square(0), from_above(20, 0)); }).empty());
}

TEST(MeshViews, SaysWhenThereIsNothingToSee) {
  const Image8 picture = mesh_views({});
  EXPECT_GE(picture.cols, 480);
  EXPECT_EQ(picture.rows, 160);
}

TEST(MeshViews, ShowsThreeViewsAndBacksInOchre) {
  TriangleMesh mesh = sphere(0.05, 30);
  const Image8 outside = mesh_views(mesh, {.panel = 200});
  EXPECT_EQ(outside.cols, 3 * 200 + 2 * 10);
  for (TriangleMesh::Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  const Image8 inside = mesh_views(mesh, {.panel = 200});
  for (const int panel : {0, 1, 2}) {
    const int x = panel * 210 + 100;
    const int y = 34 + 100;
    EXPECT_GT(pixel_color(outside, x, y)[2], pixel_color(outside, x, y)[0]);  // blue over red
    EXPECT_LT(pixel_color(inside, x, y)[2], pixel_color(inside, x, y)[0]);    // ochre
  }
}

TEST(MeshViews, ChecksItsOptions) {
  EXPECT_NE(error_of([] { mesh_views({}, {.panel = 5}); }).find("panel"), std::string::npos);
}

}  // namespace
}  // namespace facula
