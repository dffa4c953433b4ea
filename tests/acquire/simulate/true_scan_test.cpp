// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace facula {
namespace {

using Eigen::Vector3d;

TEST(TrueScan, OnAWallIsTheCommonPointOfThreePlanes) {
  const Rig rig = small_head();
  const double depth = 2.2;
  const PolarScan scan =
      true_scan(scene_with({wall_at(depth)}), rig, {}, {0.0}, quiet_options(rig));
  ASSERT_EQ(scan.rows, 120);
  for (int r = 0; r < scan.rows; ++r) {
    ASSERT_EQ(scan.valid[scan.index(r, 0)], 1) << r;
    Eigen::Matrix3d planes;  // sheet, wall, row
    planes << rig.lasers[0].normal.transpose(), 0, 0, 1, 0, 600, rig.camera.cy - r;
    const Vector3d expected = planes.inverse() * Vector3d(0.25, depth, 0);
    EXPECT_TRUE(is_near_point(scan.point[scan.index(r, 0)].cast<double>(), expected, 5e-7)) << r;
    EXPECT_EQ(scan.sigma[scan.index(r, 0)], 0);
  }
}

void expect_true_points(const Scene& scene,
                        const Rig& rig,
                        const RigidTransform& world_from_scan,
                        const PolarScan& scan) {
  for (int col = 0; col < scan.cols; ++col) {
    const RigidTransform camera_from_scan =
        rig.axis.scan_from_camera_at(scan.axis_position[static_cast<std::size_t>(col)]).inverse();
    for (int row = 0; row < scan.rows; ++row) {
      const std::size_t cell = scan.index(row, col);
      if (scan.valid[cell] == 0) continue;
      const Vector3d x_in_scan = scan.point[cell].cast<double>();
      const Vector3d x = camera_from_scan * x_in_scan;
      const double rounding = 2e-7 * x.norm() + 1e-7;  // of the float point
      EXPECT_NEAR(rig.lasers[0].normal.dot(x), rig.lasers[0].distance, rounding);
      EXPECT_LT(scene.distance(world_from_scan * x_in_scan), rounding);
      EXPECT_NEAR(rig.camera.project(x).y(), row, 1e-6 * rig.camera.height);
    }
  }
}

TEST(TrueScan, InTheRoomLiesOnSheetAndSurfaceAndInItsRow) {
  const Scene scene = read_scene(shipped_data("scenes/furnished_room.toml"));
  const Rig rig = read_rig(shipped_data("rigs/head_fs1500.toml"));
  RigidTransform world_from_scan;
  world_from_scan.translation = {0.2, 0.8, 1.1};
  world_from_scan.rotation = Eigen::AngleAxisd(0.3, Vector3d::UnitZ());
  std::vector<double> positions(30);
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = 0.21 * static_cast<double>(i);
  const PolarScan scan = true_scan(scene, rig, world_from_scan, positions, options_for(rig));
  EXPECT_GT(scan.valid_count(), 30U * 480U * 9 / 10);
  expect_true_points(scene, rig, world_from_scan, scan);
  for (std::size_t col = 0; col < positions.size(); ++col) {
    EXPECT_NEAR(scan.sensor_origin[col].head<2>().norm(), std::hypot(0.020, 0.057), 1e-12);
  }
}

TEST(TrueScan, OnTheTurntableTurnsWithTheObject) {
  const Scene scene = read_scene(shipped_data("scenes/turntable_object.toml"));
  const Rig rig = read_rig(shipped_data("rigs/ciclop_turntable.toml"));
  const PolarScan scan = true_scan(scene, rig, {}, {0.0, 0.9, 2.4, 5.0}, options_for(rig));
  EXPECT_GT(scan.valid_count(), 4U * 500U);
  expect_true_points(scene, rig, {}, scan);
}

TEST(TrueScan, DoesNotDependOnTheNumberOfThreads) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.num_threads = 1;
  const Scene scene = scene_with({wall_at(2), box_at({0, 0.2, 1.7}, {0.3, 0.2, 0.2})});
  const std::vector<double> positions(5, 0.0);
  const PolarScan one = true_scan(scene, rig, {}, positions, options);
  options.num_threads = 2;
  const PolarScan two = true_scan(scene, rig, {}, positions, options);
  EXPECT_EQ(one.range, two.range);
  EXPECT_EQ(one.valid, two.valid);
}

// The same head on its side: rows and columns change places.
TEST(TrueScan, CountsColumnsWhereTheStripeLiesLevel) {
  Rig rig = small_head();
  const PolarScan upright = true_scan(scene_with({wall_at(2)}), rig, {}, {0.0}, quiet_options(rig));
  Rig level = rig;
  std::swap(level.camera.width, level.camera.height);
  std::swap(level.camera.cx, level.camera.cy);
  level.lasers[0].normal = {0, rig.lasers[0].normal.x(), rig.lasers[0].normal.z()};
  level.stripe_direction = StripeDirection::kPerColumn;
  const PolarScan turned =
      true_scan(scene_with({wall_at(2)}), level, {}, {0.0}, quiet_options(level));
  ASSERT_EQ(turned.rows, upright.rows);
  for (int r = 0; r < turned.rows; ++r) {
    const Eigen::Vector3f a = upright.point[upright.index(r, 0)];
    const Eigen::Vector3f b = turned.point[turned.index(r, 0)];
    EXPECT_TRUE(is_near_point(Vector3d(b.y(), b.x(), b.z()), a.cast<double>(), 1e-6)) << r;
  }
}

// Where a row sees the sheet twice, on a dark near edge and on the bright wall, the wall is kept.
TEST(TrueScan, KeepsTheBrightestOfSeveral) {
  const Rig rig = small_head();
  SceneObject dark = box_at({0, 0, 1.6}, {2, 0.06, 0.02});
  dark.albedo = 0.01;
  // A level bar: its face hides the wall in its rows from the camera only where it stands before
  // it; the sheet meets bar and wall in different columns, so both are in view.
  dark.world_from_object.translation.x() = 1.03;  // from x = 0.03: the wall's line stays in view
  const Scene scene = scene_with({wall_at(2), dark});
  const PolarScan scan = true_scan(scene, rig, {}, {0.0}, quiet_options(rig));
  int on_wall = 0;
  int on_bar = 0;
  for (int r = 0; r < scan.rows; ++r) {
    if (scan.valid[scan.index(r, 0)] == 0) continue;
    (scan.point[scan.index(r, 0)].z() > 1.9F ? on_wall : on_bar) += 1;
  }
  // The bar covers 600 * 0.06 / 1.59 = 22 rows seen from the camera and shades
  // 600 * (0.06 * 2 / 1.59) / 2 = 22 rows of the wall, the same ones.
  EXPECT_NEAR(on_bar, 22, 2);
  EXPECT_NEAR(on_wall, 98, 2);
}

TEST(OptionsFor, GiveALineOfTwoPixelsAtTheWorkingDistance) {
  for (const char* name : {"rigs/head_fs1500.toml", "rigs/ciclop_turntable.toml"}) {
    const Rig rig = read_rig(shipped_data(name));
    const SimulateOptions options = options_for(rig);
    options.check();
    const double distance = rig.lasers[0].distance / rig.lasers[0].normal.z();
    const double r = (Vector3d(0, 0, distance) - options.laser_origin).norm();
    const double w = options.line_half_width + options.line_divergence * r;
    EXPECT_NEAR(rig.camera.fx * w / distance, 2.0, 0.15) << name;
    EXPECT_NEAR(rig.lasers[0].normal.dot(options.laser_origin), rig.lasers[0].distance, 1e-12);
  }
}

// The figures the pan head is tuned for: 1.5 to 3 px wide and above 15 DN from 0.5 to 6 m.
TEST(OptionsFor, SuitThePanHeadFromHalfAMetreToSix) {
  const Rig rig = read_rig(shipped_data("rigs/head_fs1500.toml"));
  const SimulateOptions options = options_for(rig);
  for (const double z : {0.5, 1.0, 2.0, 3.0, 6.0}) {
    const double r = std::hypot(z, 0.25);
    const double w = options.line_half_width + options.line_divergence * r;
    const double w1 = options.line_half_width + options.line_divergence;
    EXPECT_GT(600 * w / z, 1.5) << z;
    EXPECT_LT(600 * w / z, 3.0) << z;
    const double peak = 0.7 * options.laser_peak * w1 / w;
    EXPECT_GT(peak, 15) << z;
    EXPECT_LT(peak, 255) << z;
  }
}

}  // namespace
}  // namespace facula
