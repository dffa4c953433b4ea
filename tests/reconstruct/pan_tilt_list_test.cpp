// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/pan_tilt_list.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

TEST(PanTiltList, PutsPointsWhereTheAxesLook) {
  const TemporaryFolder folder;
  const auto file = folder.write("scan.csv",
                                 "range_mm,strength,pan_deg,tilt_deg\n"
                                 "1000,50,0.00,90.00\n"
                                 "2000,100,90.00,90.00\n"
                                 "3000,25,90.00,0.00\n");
  ASSERT_TRUE(is_pan_tilt_list(file));
  const PosedCloud scan = posed_cloud(read_pan_tilt_list(file));
  ASSERT_EQ(scan.cloud.size(), 3U);
  EXPECT_TRUE(is_near_point(scan.cloud.points[0].cast<double>(), {1, 0, 0}, 1e-6));
  EXPECT_TRUE(is_near_point(scan.cloud.points[1].cast<double>(), {0, 2, 0}, 1e-6));
  EXPECT_TRUE(is_near_point(scan.cloud.points[2].cast<double>(), {0, 0, 3}, 1e-6));
  EXPECT_NEAR(scan.cloud.intensity[0], 0.5, 1e-6);
  const PosedCloud turned = posed_cloud(read_pan_tilt_list(file), -30 * kDegree);
  EXPECT_TRUE(is_near_point(
      turned.cloud.points[0].cast<double>(), {std::sin(M_PI / 3), 0, std::cos(M_PI / 3)}, 1e-6));
}

TEST(PanTiltList, MakesAGridOfSweepsThatGoUpAndDown) {
  const TemporaryFolder folder;
  std::string text = "range_mm,pan_deg,tilt_deg\n";
  for (int row = 0; row < 4; ++row) text += "1000,0," + std::to_string(40 + 10 * row) + "\n";
  for (int row = 3; row >= 0; --row) text += "1000,5," + std::to_string(40 + 10 * row) + "\n";
  text += "0,10,40\n1000,10,60\n";
  const PosedCloud scan = posed_cloud(read_pan_tilt_list(folder.write("scan.csv", text)));
  EXPECT_EQ(scan.grid.rows, 4);
  EXPECT_EQ(scan.grid.cols, 3);
  EXPECT_NO_THROW(scan.grid.check(scan.cloud.size()));
  EXPECT_EQ(scan.grid.point[scan.grid.index(0, 1)], 7);
  EXPECT_EQ(scan.grid.point[scan.grid.index(3, 1)], 4);
  EXPECT_EQ(scan.grid.point[scan.grid.index(0, 2)], ScanGrid::kNone);  // a range of 0
  EXPECT_EQ(scan.grid.point[scan.grid.index(2, 2)], 8);
}

TEST(PanTiltSweeps, ArePartedByTheWayTheAxisMoved) {
  PanTiltList list;
  for (const double pan : {0.0, 0.1, 0.2}) {
    for (int i = 0; i < 5; ++i) {
      list.range.push_back(1 + pan);
      list.pan.push_back(pan);
      list.tilt.push_back(pan == 0.1 ? 2 - 0.1 * i : 1 + 0.1 * i);
    }
  }
  list.tilt[10] = 3;  // the end of the sweep before
  const PanTiltSweeps sweeps = sweeps_of(list);
  EXPECT_EQ(sweeps.rising.size(), 10U);
  EXPECT_EQ(sweeps.falling.range, std::vector<double>(5, 1.1));
  EXPECT_TRUE(sweeps_of({}).rising.range.empty());
}

TEST(PanTiltList, IsReadAsAScanOfAProject) {
  const TemporaryFolder folder;
  const auto file = folder.write("corner.csv", "range_m,pan_rad,tilt_rad\n1,0,1\n1,0,2\n2,1,1\n");
  const ScanProject project = read_scan_project(file);
  ASSERT_EQ(project.scans.size(), 1U);
  EXPECT_EQ(project.scans[0].name, "corner");
  EXPECT_EQ(project.scans[0].cloud.size(), 3U);
  EXPECT_EQ(project.scans[0].cloud.sensor_origin.size(), 3U);
  EXPECT_EQ(project.scans[0].grid.cols, 2);
}

TEST(PanTiltList, RefusesTablesOfAnotherKindAndDamagedOnes) {
  const TemporaryFolder folder;
  EXPECT_FALSE(is_pan_tilt_list(folder.write("points.csv", "x,y,z\n1,2,3\n")));
  EXPECT_FALSE(is_pan_tilt_list(folder / "absent.csv"));
  const auto refused = [&](const std::string& text, const std::string& because) {
    const auto file = folder.write("bad.csv", text);
    const std::string error = error_of([&] { read_pan_tilt_list(file); });
    EXPECT_NE(error.find(because), std::string::npos) << error;
  };
  refused("range_mm,pan_deg,tilt_deg\n", "rows");
  refused("range_mm,pan_deg,tilt_deg\n0,1,2\n0,1,3\n", "ranges");
  refused("range_mm,pan_deg,tilt_deg\n-5,1,2\n", "0 (nothing seen)");
  refused("range_mm,pan_deg,tilt_deg\n5,nan,2\n", "finite");
  refused("range_mm,pan_deg,tilt_deg\n5,1\n", "cells");
  refused("range_mm,pan_deg\n5,1\n", "tilt_deg");
}

TEST(PanTiltListRealData, HoldsEveryRangeOfTheFile) {
  FACULA_REQUIRE_REAL_DATA(file, "range/os3ds-rotating-lidar/210716-1718-LiDAR-90-Fine.csv");
  const PosedCloud scan = posed_cloud(read_pan_tilt_list(file));
  EXPECT_EQ(scan.cloud.size(), 11700U);
  EXPECT_EQ(scan.grid.cols, 80);
  std::size_t cells = 0;
  for (const std::int32_t p : scan.grid.point) cells += p != ScanGrid::kNone ? 1U : 0U;
  EXPECT_GT(cells, 11600U);
}

}  // namespace
}  // namespace facula
