// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/reconstruct/mesh/volumetric_merge.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <filesystem>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace facula {
namespace {

/// How many triangles a straight way from `from` to `to` crosses.
int crossings(const TriangleMesh& mesh, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  int count = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[i].cast<double>();
    Eigen::Matrix3d system;
    system << mesh.vertices[j].cast<double>() - a, mesh.vertices[k].cast<double>() - a, from - to;
    if (std::abs(system.determinant()) < 1e-18) continue;
    const Eigen::Vector3d at = system.inverse() * (from - a);
    if (at.minCoeff() >= 0 && at.x() + at.y() <= 1 && at.z() <= 1) ++count;
  }
  return count;
}

TEST(PotHandles, LetAStickThroughAndStandAroundIt) {
  FACULA_REQUIRE_REAL_DATA(frames, "laser/caltag_turntable_pot");
  const std::filesystem::path shipped = shipped_data("captures/caltag_turntable_pot");
  Capture capture = read_capture(shipped, frames);
  capture.rig = read_rig(shipped / "rig_joint.toml");
  const PolarScan scan = extract_scan(capture).scan;
  ScanProject project;
  project.scans.push_back({.name = "pot",
                           .file = {},
                           .cloud = cloud_from_scan(scan),
                           .world_from_scan = {},
                           .grid = grid_from_scan(scan)});
  const TriangleMesh mesh = merge_volumetric(project).mesh;
  EXPECT_EQ(mesh_statistics(mesh).non_manifold_edges, 0U);
  // The pot's belly is a circle of 59 mm about (13, -5) mm; its handles stand at -84 and 93
  // degrees.
  const Eigen::Vector3d axis(0.013, -0.005, 0.092);
  for (const double degrees : {-84.0, 93.0}) {
    const Eigen::Vector3d out = Eigen::AngleAxisd(degrees * M_PI / 180, Eigen::Vector3d::UnitZ()) *
                                Eigen::Vector3d::UnitX();
    const Eigen::Vector3d along = Eigen::Vector3d::UnitZ().cross(out);
    const Eigen::Vector3d eye = axis + 0.058 * out;
    EXPECT_EQ(crossings(mesh, eye - 0.03 * along, eye + 0.03 * along), 0) << degrees;
    EXPECT_EQ(crossings(mesh, eye, eye + 0.03 * out), 1) << degrees;
  }
}

}  // namespace
}  // namespace facula
