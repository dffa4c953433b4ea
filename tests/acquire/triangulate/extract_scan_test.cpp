// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A wall at 2 m, turned by 20 degrees about the upright.
Scene turned_wall() {
  SceneObject wall = wall_at(2);
  wall.world_from_object.rotation = Eigen::AngleAxisd(0.35, Eigen::Vector3d::UnitY());
  return scene_with({wall});
}

struct Spread {
  double chi2 = 0;    ///< mean of (error along the ray / sigma)^2 [1]
  double points = 0;  ///< [1]
};

Spread against_truth(const PolarScan& scan, const PolarScan& truth) {
  Spread spread;
  for (int col = 0; col < scan.cols; ++col) {
    const Eigen::Vector3d eye = scan.sensor_origin[static_cast<std::size_t>(col)];
    for (int row = 0; row < scan.rows; ++row) {
      const std::size_t cell = scan.index(row, col);
      if (scan.valid[cell] == 0 || truth.valid[cell] == 0) continue;
      const Eigen::Vector3d x = truth.point[cell].cast<double>();
      const Eigen::Vector3d error = scan.point[cell].cast<double>() - x;
      const double z = error.dot((x - eye).normalized()) / static_cast<double>(scan.sigma[cell]);
      spread.chi2 += z * z;
      spread.points += 1;
    }
  }
  spread.chi2 /= spread.points;
  return spread;
}

class ExtractScan : public testing::Test {
 protected:
  /// Ten frames of the turned wall by a head that stands still.
  Capture wall_capture(const Rig& rig, const SimulateOptions& options) const {
    SimulatedRun run;
    run.positions.assign(10, 0.0);
    simulate_capture(folder_ / "run", turned_wall(), rig, run, options);
    return read_capture(folder_ / "run");
  }

  PolarScan truth() const { return read_scan(folder_ / "run" / "truth.pcd"); }

  TemporaryFolder folder_;
};

/// Chi2 over 1200 points spreads by 0.04.
TEST_F(ExtractScan, StatesAnHonestSigmaOnAWall) {
  for (const bool background : {false, true}) {
    for (const double read_noise : {0.7, 1.5, 4.0}) {
      const Rig rig = small_head();
      SimulateOptions options = options_for(rig);
      options.read_noise = read_noise;
      options.background_frames = background;
      const ExtractResult result = extract_scan(wall_capture(rig, options));
      const Spread spread = against_truth(result.scan, truth());
      EXPECT_EQ(spread.points, 1200) << "read noise " << read_noise;
      EXPECT_GT(spread.chi2, 0.8) << "read noise " << read_noise << " background " << background;
      EXPECT_LT(spread.chi2, 1.2) << "read noise " << read_noise << " background " << background;
    }
  }
}

/// The head laid on its side: what was an image column is now a row.
TEST_F(ExtractScan, ReadsAStripeThatRunsPerColumn) {
  Rig rig = small_head();
  std::swap(rig.camera.width, rig.camera.height);
  std::swap(rig.camera.cx, rig.camera.cy);
  std::swap(rig.lasers[0].normal.x(), rig.lasers[0].normal.y());
  rig.stripe_direction = StripeDirection::kPerColumn;
  const ExtractResult result = extract_scan(wall_capture(rig, options_for(rig)));
  EXPECT_EQ(result.scan.rows, 120);
  const Spread spread = against_truth(result.scan, truth());
  EXPECT_EQ(spread.points, 1200);
  EXPECT_GT(spread.chi2, 0.8);
  EXPECT_LT(spread.chi2, 1.2);
}

TEST_F(ExtractScan, RefusesACaptureThatContradictsItself) {
  const Capture good = wall_capture(small_head(), options_for(small_head()));
  Capture capture = good;
  capture.laser = 1;
  EXPECT_NE(error_of([&] { extract_scan(capture); }).find("lit laser below 1"), std::string::npos);
  capture = good;
  capture.positions.pop_back();
  EXPECT_NE(error_of([&] { extract_scan(capture); }).find("9 positions for 10"), std::string::npos);
  capture = good;
  capture.stripe.direction = StripeDirection::kPerColumn;
  EXPECT_NE(error_of([&] { extract_scan(capture); }).find("direction"), std::string::npos);
  capture = good;
  capture.zero_line = ZeroLine{};
  EXPECT_NE(error_of([&] { extract_scan(capture); }).find("zero_line"), std::string::npos);
  capture = good;
  capture.background.assign(3, good.frames[0]);
  EXPECT_NE(error_of([&] { extract_scan(capture); }).find("got 3 for 10"), std::string::npos);
}

}  // namespace
}  // namespace facula
