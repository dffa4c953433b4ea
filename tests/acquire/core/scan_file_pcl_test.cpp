// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

namespace facula {
namespace {

TEST(ScanFilePcl, PclReadsOurScan) {
  const TemporaryFolder folder;
  PolarScan scan = PolarScan::empty(2, 3);
  scan.set(scan.index(1, 2), {1.25, 2.5, -3.75}, 0.5F, 0.001F);
  scan.world_from_scan.translation = {7, 8, 9};
  write_scan(folder / "a.pcd", scan);
  pcl::PointCloud<pcl::PointXYZI> cloud;
  ASSERT_EQ(pcl::io::loadPCDFile((folder / "a.pcd").string(), cloud), 0);
  ASSERT_EQ(cloud.width, 3U);
  ASSERT_EQ(cloud.height, 2U);
  EXPECT_EQ(cloud.at(2, 1).getVector3fMap(), Eigen::Vector3f(1.25F, 2.5F, -3.75F));
  EXPECT_EQ(cloud.at(2, 1).intensity, 0.5F);
  EXPECT_TRUE(std::isnan(cloud.at(0, 0).x));
  EXPECT_EQ(cloud.sensor_origin_.head<3>(), Eigen::Vector3f(7, 8, 9));
}

TEST(ScanFilePcl, PclReadsOurColoursAndNormals) {
  const TemporaryFolder folder;
  PointCloud cloud;
  cloud.points = {{1, 2, 3}};
  cloud.normals = {{0, 0.6F, 0.8F}};
  cloud.colors = {{10, 200, 30}};
  write_cloud(folder / "a.pcd", cloud);
  pcl::PointCloud<pcl::PointXYZRGBNormal> read;
  ASSERT_EQ(pcl::io::loadPCDFile((folder / "a.pcd").string(), read), 0);
  EXPECT_EQ(read[0].getNormalVector3fMap(), cloud.normals[0]);
  EXPECT_EQ(read[0].r, 10);
  EXPECT_EQ(read[0].g, 200);
  EXPECT_EQ(read[0].b, 30);
}

TEST(ScanFilePcl, ReadsAllThreeEncodingsOfPcl) {
  const TemporaryFolder folder;
  pcl::PointCloud<pcl::PointXYZRGB> cloud(40, 30);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto value = static_cast<float>(i);
    cloud[i].getVector3fMap() = Eigen::Vector3f(value, value / 3, -value);
    cloud[i].r = static_cast<std::uint8_t>(i % 256);
    cloud[i].g = 128;
    cloud[i].b = 7;
  }
  pcl::PCDWriter writer;
  ASSERT_EQ(writer.writeASCII((folder / "t.pcd").string(), cloud, 9), 0);
  ASSERT_EQ(writer.writeBinary((folder / "b.pcd").string(), cloud), 0);
  ASSERT_EQ(writer.writeBinaryCompressed((folder / "c.pcd").string(), cloud), 0);
  for (const char* name : {"t.pcd", "b.pcd", "c.pcd"}) {
    const PointCloud read = read_cloud(folder / name);
    ASSERT_EQ(read.size(), cloud.size()) << name;
    for (std::size_t i = 0; i < read.size(); ++i) {
      ASSERT_EQ(read.points[i], cloud[i].getVector3fMap()) << name;
      ASSERT_EQ(read.colors[i], (Color{cloud[i].r, cloud[i].g, cloud[i].b})) << name;
    }
    const PolarScan scan = read_scan(folder / name);
    EXPECT_EQ(scan.point[scan.index(29, 39)], cloud.at(39, 29).getVector3fMap()) << name;
  }
}

TEST(ScanFilePcl, UnpacksARoomAsPclDoes) {
  FACULA_REQUIRE_REAL_DATA(path, "range/pcl-data/room_scan1.pcd");
  pcl::PointCloud<pcl::PointXYZ> theirs;
  ASSERT_EQ(pcl::io::loadPCDFile(path.string(), theirs), 0);
  const PointCloud ours = read_cloud(path);
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t i = 0; i < ours.size(); ++i) {
    ASSERT_EQ(ours.points[i], theirs[i].getVector3fMap());
  }
}

}  // namespace
}  // namespace facula
