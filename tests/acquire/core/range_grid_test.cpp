// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/range_grid.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A range image as Cyberware's: the cell (row, col) sees x = 0.5 mm per column, and y along its
/// line of sight, all of which meet at y = 0.1, z = `meet`.
std::string range_image(int rows, int cols, double meet) {
  std::ostringstream vertices;
  std::ostringstream cells;
  int count = 0;
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      if ((row + col) % 5 == 0) {
        cells << "0\n";
        continue;
      }
      const double z = 0.02 * std::sin(0.3 * col) + 0.03 * std::cos(0.2 * row);
      const double y = 0.1 + (0.0007 * row - 0.1) * (meet - z) / meet;
      vertices << 0.0005 * col << " " << y << " " << z << "\n";
      cells << "1 " << count++ << "\n";
    }
  }
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nobj_info is_mesh 0\nobj_info num_cols " << cols
       << "\nobj_info num_rows " << rows << "\nelement vertex " << count
       << "\nproperty float x\nproperty float y\nproperty float z\nelement range_grid "
       << rows * cols << "\nproperty list uchar int vertex_indices\nend_header\n"
       << vertices.str() << cells.str();
  return text.str();
}

TEST(RangeGrid, PutsEveryPointIntoTheCellItWasScannedIn) {
  const TemporaryFolder folder;
  ScanGrid grid;
  const PointCloud cloud = read_cloud(folder.write("a.ply", range_image(30, 20, 1.2)), &grid);
  ASSERT_EQ(grid.rows, 30);
  ASSERT_EQ(grid.cols, 20);
  EXPECT_EQ(grid.point[grid.index(0, 0)], ScanGrid::kNone);
  for (int row = 0; row < 30; ++row) {
    for (int col = 0; col < 20; ++col) {
      const std::int32_t p = grid.point[grid.index(row, col)];
      ASSERT_EQ(p == ScanGrid::kNone, (row + col) % 5 == 0);
      if (p < 0) continue;
      EXPECT_NEAR(cloud.points[std::size_t(p)].x(), 0.0005 * col, 1e-7);
    }
  }
}

TEST(RangeGrid, FindsTheSideOfTheScannerFromTheLinesOfSight) {
  const TemporaryFolder folder;
  for (const double meet : {1.2, -1.2, 0.4}) {
    ScanGrid grid;
    const PointCloud cloud = read_cloud(folder.write("a.ply", range_image(60, 40, meet)), &grid);
    ASSERT_EQ(cloud.sensor_origin.size(), cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3f& p = cloud.points[i];
      const Eigen::Vector3f sight = cloud.sensor_origin[i] - p;
      const Eigen::Vector3f truth = Eigen::Vector3f(0, 0.1F - p.y(), float(meet) - p.z());
      EXPECT_NEAR(sight.norm(), 1, 1e-5);
      EXPECT_GT(sight.dot(truth.normalized()), std::cos(0.005F)) << "meeting at " << meet;
    }
  }
}

TEST(RangeGrid, TakesParallelLinesOfSightAsSeenFromAbove) {
  const TemporaryFolder folder;
  ScanGrid grid;
  const PointCloud cloud = read_cloud(folder.write("a.ply", range_image(60, 40, 1e9)), &grid);
  ASSERT_EQ(cloud.sensor_origin.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    EXPECT_GT((cloud.sensor_origin[i] - cloud.points[i]).z(), 0.99F);
  }
}

TEST(RangeGrid, LeavesPointsThatAreNotFiniteOut) {
  const TemporaryFolder folder;
  const std::string head =
      "ply\nformat ascii 1.0\nobj_info num_cols 3\nobj_info num_rows 1\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nelement range_grid 3\n"
      "property list uchar int vertex_indices\nend_header\n";
  ScanGrid grid;
  const auto file = folder.write("a.ply", head + "1 0 0\nnan 0 0\n2 0 0\n1 0\n1 1\n1 2\n");
  EXPECT_EQ(read_cloud(file, &grid).size(), 2U);
  EXPECT_EQ(grid.point, (std::vector<std::int32_t>{0, ScanGrid::kNone, 1}));
}

TEST(RangeGrid, SaysWhatDoesNotFit) {
  const TemporaryFolder folder;
  const auto sentence = [&](const std::string& infos, const std::string& cells) {
    const auto file = folder.write(
        "a.ply",
        "ply\nformat ascii 1.0\n" + infos +
            "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
            "element range_grid 2\nproperty list uchar int vertex_indices\nend_header\n"
            "1 0 0\n2 0 0\n" +
            cells);
    ScanGrid grid;
    return error_of([&] { read_cloud(file, &grid); });
  };
  const std::string fine = "obj_info num_cols 2\nobj_info num_rows 1\n";
  EXPECT_NE(sentence("", "1 0\n1 1\n").find("num_rows"), std::string::npos);
  EXPECT_NE(sentence("obj_info num_cols 9999999999\nobj_info num_rows 1\n", "1 0\n1 1\n")
                .find("range_grid of 2 cells"),
            std::string::npos);
  EXPECT_NE(sentence(fine, "1 0\n1 2\n").find("names vertex 2 of 2"), std::string::npos);
  EXPECT_NE(sentence(fine, "1 -1\n1 1\n").find("names vertex -1"), std::string::npos);
  EXPECT_NE(sentence(fine, "2 0 1\n0\n").find("more than one"), std::string::npos);
  EXPECT_NE(sentence(fine, "1 0\n1 0\n").find("another cell"), std::string::npos);
}

}  // namespace
}  // namespace facula
