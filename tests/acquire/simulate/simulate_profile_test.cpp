// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/laser_fan.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(SimulateProfile, IsTheProjectionOfTheTruthPlusNoise) {
  Rig rig = small_head();
  rig.camera.k1 = -0.1;
  rig.lasers[0].bow = 0.03;
  SimulateOptions options = quiet_options(rig);
  const Scene scene = scene_with({wall_at(2), box_at({0.02, 0, 1.8}, {0.1, 0.1, 0.1})});
  const PolarScan truth = true_scan(scene, rig, {}, {0.0}, options);
  options.stripe_noise = 0;
  const StripeProfile exact = simulate_profile(scene, rig, {}, 0, options);
  ASSERT_EQ(exact.size(), 120U);
  ASSERT_GT(exact.seen_count(), 60U);
  for (std::size_t r = 0; r < exact.size(); ++r) {
    ASSERT_EQ(exact.seen[r], truth.valid[r]);
    if (exact.seen[r] == 0) continue;
    EXPECT_NEAR(exact.position[r], rig.camera.project(truth.point[r].cast<double>()).x(), 2e-4);
  }
  options.stripe_noise = 0.1;
  double square = 0;
  double count = 0;
  for (std::uint64_t frame = 0; frame < 50; ++frame) {
    const StripeProfile noisy = simulate_profile(scene, rig, {}, frame, options);
    for (std::size_t r = 0; r < exact.size(); ++r) {
      if (exact.seen[r] == 0) continue;
      square += std::pow(noisy.position[r] - exact.position[r], 2);
      EXPECT_FLOAT_EQ(noisy.sigma[r], 0.1F);
      ++count;
    }
  }
  EXPECT_NEAR(std::sqrt(square / count), 0.1, 4 * 0.1 / std::sqrt(2 * count));
}

// The slopes of the sources' tables, in the middle row: d = A / (x0 - px).
TEST(SourceHeads, SeeAPlaneWhereTheirTablesDo) {
  struct Case {
    const char* rig;
    double slope;  // A [px m]
    double zero;   // x0 [px]
  };
  for (const Case& head : {Case{"rigs/head_fs760.toml", 75.1, 493.52},
                           Case{"rigs/head_fs1500_tables.toml", 137.3, 480.69}}) {
    Rig rig = read_rig(shipped_data(head.rig));
    rig.axis = Axis{};
    SimulateOptions options = options_for(rig);
    options.stripe_noise = 0;
    for (const double distance : {0.5, 1.0, 2.0, 4.0}) {
      const StripeProfile line =
          simulate_profile(scene_with({wall_at(distance)}), rig, {}, 0, options);
      ASSERT_EQ(line.seen_count(), 480U) << head.rig;
      const double middle = 0.5 * (line.position[239] + line.position[240]);
      EXPECT_NEAR(middle, head.zero - head.slope / distance, 0.01) << head.rig << ' ' << distance;
    }
  }
}

// Top and bottom rows against the centre, tables 3.3 and 3.4, mean over 0.8 m and beyond.
TEST(SourceHeads, BendTheLineAsMuchAsTheTables) {
  struct Case {
    const char* rig;
    double top;     // mean of the table's top - centre [px]
    double bottom;  // of its bottom - centre [px]
  };
  for (const Case& head : {Case{"rigs/head_fs760.toml", 1.55, -1.21},
                           Case{"rigs/head_fs1500_tables.toml", 0.84, -1.35}}) {
    Rig rig = read_rig(shipped_data(head.rig));
    rig.axis = Axis{};
    SimulateOptions options = options_for(rig);
    options.stripe_noise = 0;
    const StripeProfile line = simulate_profile(scene_with({wall_at(2)}), rig, {}, 0, options);
    const double middle = 0.5 * (line.position[239] + line.position[240]);
    EXPECT_NEAR(line.position[0] - middle, head.top, 0.02) << head.rig;
    EXPECT_NEAR(line.position[479] - middle, head.bottom, 0.02) << head.rig;
  }
}

// b s sec^2(a) / (B + s tan(a)): the height of a spot s beside the sensor's middle (source D).
TEST(SourceHeads, ProfileBenchSeesHeightsAsItsFormulaSays) {
  Rig rig = read_rig(shipped_data("rigs/profile_bench.toml"));
  SimulateOptions options = options_for(rig);
  options.stripe_noise = 0;
  const RigidTransform pose = rig.axis.scan_from_camera_at(0);
  for (const double height : {0.0, 0.01, 0.04}) {
    const Scene scene = scene_with({box_at({0, 0, height - 0.5}, {1, 1, 1})});
    const StripeProfile line = simulate_profile(scene, rig, pose, 0, options);
    ASSERT_EQ(line.seen[767], 1);
    const double shift = (rig.camera.cy - line.position[767]) / rig.camera.fy;  // s / B
    const double found = 0.1343502884254441 * shift * 2 / (1 + shift);
    EXPECT_NEAR(found, height, 1e-6) << height;
  }
}

// z = f * (distance of the lines) / (their distance in the image), source E (4), in both media.
TEST(SourceHeads, TwoLineHeadsSeeTheirLinesAsFarApartAsTheFormulaSays) {
  for (const char* name : {"rigs/two_line_air.toml", "rigs/two_line_water.toml"}) {
    const Rig rig = read_rig(shipped_data(name));
    SimulateOptions options = options_for(rig);
    options.stripe_noise = 0;
    for (const double distance : {0.61, 2.14, 3.975}) {
      const Scene scene = scene_with({wall_at(distance)});
      double position[2];
      for (const std::size_t laser : {0U, 1U}) {
        options.laser = laser;
        options.laser_origin = beside_camera(rig.lasers[laser]);
        position[laser] = simulate_profile(scene, rig, {}, 0, options).position[320];
      }
      EXPECT_NEAR(rig.camera.fy * 0.1 / (position[1] - position[0]), distance, 1e-5 * distance);
    }
  }
}

}  // namespace
}  // namespace facula
