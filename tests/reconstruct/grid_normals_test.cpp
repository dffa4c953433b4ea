// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/reconstruct/filter/grid_normals.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/meshes.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A grid of points seen from the origin: rows step along y, columns along x, depth from `z`.
template <typename Depth>
std::pair<PointCloud, ScanGrid> scanned(int rows, int cols, const Depth& z) {
  PointCloud cloud;
  ScanGrid grid{rows, cols, {}};
  for (int col = 0; col < cols; ++col) {
    for (int row = 0; row < rows; ++row) {
      const double x = 0.01 * (col - cols / 2);
      const double y = 0.002 * (row - rows / 2);
      const double depth = z(x, y);
      grid.point.push_back(depth > 0 ? std::int32_t(cloud.size()) : ScanGrid::kNone);
      if (depth > 0) cloud.points.emplace_back(float(x * depth), float(y * depth), float(depth));
    }
  }
  cloud.sensor_origin.assign(cloud.size(), Eigen::Vector3f::Zero());
  return {cloud, grid};
}

TEST(GridNormals, AreExactOnAPlaneAndLookAtTheSensor) {
  // The plane 0.3 x - 0.2 y + z = 2 in ray coordinates.
  const auto [cloud, grid] =
      scanned(40, 30, [](double x, double y) { return 2 / (0.3 * x - 0.2 * y + 1); });
  const Eigen::Vector3f truth = -Eigen::Vector3f(0.3F, -0.2F, 1).normalized();
  for (const Eigen::Vector3f& n : grid_normals(cloud, grid)) EXPECT_LT((n - truth).norm(), 1e-4F);
}

TEST(GridNormals, KeepTheSidesOfADepthEdgeApart) {
  const auto [cloud, grid] =
      scanned(40, 30, [](double x, double) { return x < 0.004 ? 1.0 : 1.5; });
  for (const Eigen::Vector3f& n : grid_normals(cloud, grid)) {
    EXPECT_LT((n + Eigen::Vector3f::UnitZ()).norm(), 1e-4F);
  }
}

TEST(GridNormals, FollowASphere) {
  const Eigen::Vector3d centre(0, 0, 2);
  const auto [cloud, grid] = scanned(101, 41, [&](double x, double y) {
    const Eigen::Vector3d ray(x, y, 1);
    const double b = ray.dot(centre);
    const double a = ray.squaredNorm();
    const double root = b * b - a * (centre.squaredNorm() - 0.25 * 0.25);
    return root > 0 ? (b - std::sqrt(root)) / a : 0;
  });
  const auto normals = grid_normals(cloud, grid);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f truth = (cloud.points[i] - centre.cast<float>()).normalized();
    const double facing = -truth.dot(cloud.points[i].normalized());
    if (facing < 0.5) continue;  // towards the rim the window sees one side only
    EXPECT_LT(std::acos(std::min(1.0F, normals[i].dot(truth))), 0.1) << "facing " << facing;
  }
}

TEST(GridNormals, OfALonelyPointLooksAtTheSensor) {
  PointCloud cloud;
  cloud.points = {{0, 0, 2}};
  const ScanGrid grid{1, 1, {0}};
  EXPECT_EQ(grid_normals(cloud, grid)[0], Eigen::Vector3f(0, 0, -1));
}

TEST(GridNormals, AreTheSameForEveryNumberOfThreads) {
  const auto [cloud, grid] =
      scanned(60, 50, [](double x, double y) { return 1 + 0.2 * std::sin(9 * x + 20 * y); });
  EXPECT_EQ(grid_normals(cloud, grid, {.num_threads = 1}),
            grid_normals(cloud, grid, {.num_threads = 3}));
}

TEST(GridNormals, RefuseAGridThatDoesNotFit) {
  PointCloud cloud;
  cloud.points = {{0, 0, 2}};
  EXPECT_THROW(grid_normals(cloud, {1, 1, {1}}), Error);
  EXPECT_THROW(grid_normals(cloud, {1, 2, {0}}), Error);
  EXPECT_THROW(grid_normals(cloud, {1, 1, {0}}, {.neighbours = 3}), Error);
  EXPECT_TRUE(grid_normals({}, {}).empty());
}

TEST(GridNormals, OfAllTenBunnyScansAgreeWithThePublishedMesh) {
  FACULA_REQUIRE_REAL_DATA(folder, "range/stanford-bunny");
  const TriangleMesh mesh = read_mesh(folder / "reconstruction" / "bun_zipper.ply");
  const auto truth = vertex_normals(mesh);
  const NearestNeighbours tree(mesh.vertices);
  for (const PosedCloud& scan : read_scan_project(folder / "data" / "bun.conf").scans) {
    ASSERT_EQ(scan.grid.rows, 400) << scan.name;
    ASSERT_EQ(scan.grid.cols, 512) << scan.name;
    const PointCloud& cloud = scan.cloud;
    ASSERT_EQ(cloud.normals.size(), cloud.size()) << scan.name;
    ASSERT_EQ(cloud.sensor_origin.size(), cloud.size()) << scan.name;
    std::size_t near = 0;
    std::size_t same_side = 0;
    std::size_t close = 0;
    for (std::size_t i = 0; i < cloud.size(); i += 10) {
      const Eigen::Vector3d world = scan.world_from_scan * cloud.points[i].cast<double>();
      const auto nearest = tree.nearest(world.cast<float>());
      if (nearest.squared_distance > 1e-6F) continue;
      const Eigen::Vector3f normal =
          (scan.world_from_scan.rotation * cloud.normals[i].cast<double>()).cast<float>();
      const float cosine = normal.dot(truth[nearest.index]);
      ++near;
      if (cosine > 0) ++same_side;
      if (cosine > std::cos(0.35)) ++close;
    }
    ASSERT_GT(near, 2000U) << scan.name;
    // The rest: points at folds and thin ears whose nearest vertex is on the other side.
    EXPECT_GT(double(same_side), 0.96 * double(near)) << scan.name;
    EXPECT_GT(double(close), 0.92 * double(near)) << scan.name;
  }
}

}  // namespace
}  // namespace facula
