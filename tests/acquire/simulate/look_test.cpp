// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/conditions_file.hpp>
#include <facula/acquire/simulate/frame_renderer.hpp>
#include <facula/tests/acquire/simulate/small_head.hpp>
#include <facula/tests/support/real_data.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// How the rows of a line look that are not clipped.
struct Look {
  std::vector<double> width;      // [px]
  std::vector<double> amplitude;  // [DN]
  std::vector<double> noise;      // per frame [DN]
  std::vector<double> roughness;  // of the amplitude along the line [1]
  std::vector<double> waviness;   // of the position [px]
  double clipped = 0;             // rows
};

// How far row r leaves the parabola through the five rows about it, as one standard deviation of
// white noise on the rows would (1 - 17/35 of its variance is left; Savitzky and Golay 1964).
double off_parabola(const std::vector<float>& v, std::size_t r) {
  const double fit =
      (-3 * v[r - 2] + 12 * v[r - 1] + 17 * v[r] + 12 * v[r + 1] - 3 * v[r + 2]) / 35;
  return std::abs(v[r] - fit) / std::sqrt(18.0 / 35) / 0.6745;  // median to standard deviation
}

void look_at(Image8 lit, Image8 dark, const StripeOptions& options, Look& look) {
  const StripeProfile p = detect_stripe(lit.view(), dark.view(), options);
  look.noise.push_back(p.noise);
  const auto plain = [&](std::size_t r) { return p.seen[r] != 0 && p.saturated[r] == 0; };
  for (std::size_t r = 2; r + 2 < p.size(); ++r) {
    look.clipped += p.seen[r] != 0 && p.saturated[r] != 0 ? 1 : 0;
    if (!plain(r)) continue;
    look.width.push_back(p.width[r]);
    look.amplitude.push_back(p.amplitude[r]);
    if (!plain(r - 2) || !plain(r - 1) || !plain(r + 1) || !plain(r + 2)) continue;
    look.roughness.push_back(off_parabola(p.amplitude, r) / p.amplitude[r]);
    look.waviness.push_back(off_parabola(p.position, r));
  }
}

std::array<double, 5> medians(Look look) {
  return {median(look.width),
          median(look.amplitude),
          median(look.noise),
          median(look.roughness),
          median(look.waviness)};
}

// Prints the table that docs/simulated_head.md shows and holds each figure to its factor.
void compare(const std::string& set, const Look& real, const Look& simulated) {
  const char* names[] = {
      "width [px]", "amplitude [DN]", "noise [DN]", "roughness [1]", "waviness [px]"};
  const double factor[] = {1.15, 1.3, 1.3, 1.3, 1.3};
  const auto a = medians(real);
  const auto b = medians(simulated);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::printf("%s %s: real %.4f, simulated %.4f\n", set.c_str(), names[i], a[i], b[i]);
    EXPECT_LT(b[i], a[i] * factor[i]) << names[i];
    EXPECT_GT(b[i], a[i] / factor[i]) << names[i];
  }
}

SceneObject pot() {
  SceneObject object;
  object.name = "pot";
  object.shape = CylinderShape{0.055, 0.105};
  object.world_from_object.translation.z() = 0.052;
  object.albedo = 0.6;
  object.colour = {0.9, 0.6, 0.45};
  return object;
}

TEST(Look, OfTheLineIsThatOfThePotSet) {
  FACULA_REQUIRE_REAL_DATA(folder, "laser/caltag_turntable_pot");
  const Capture capture = read_capture(shipped_data("captures/caltag_turntable_pot"), folder);
  const CaptureFrames frames(capture);
  Look real;
  for (std::size_t i = 0; i < frames.size(); i += 9) {
    look_at(frames.lit(i), {}, capture.stripe, real);
  }
  const Rig& rig = capture.rig;
  const SimulateOptions options =
      read_conditions(shipped_data("conditions/caltag_pot.toml"), rig, options_for(rig));
  const Scene scene = scene_with({pot(), box_at({0, 0, -0.01}, {0.3, 0.3, 0.01})});
  const FrameRenderer renderer(scene, rig, options);
  Look simulated;
  for (std::uint64_t i = 0; i < 4; ++i) {
    const double angle = 0.3 * static_cast<double>(i);
    look_at(renderer.render(rig.axis.scan_from_camera_at(angle), true, i),
            {},
            capture.stripe,
            simulated);
  }
  compare("pot", real, simulated);
}

TEST(Look, OfTheLineIsThatOfTheCiclopBust) {
  FACULA_REQUIRE_REAL_DATA(folder, "laser/ciclop_bust_and_pattern");
  const Capture capture = read_capture(shipped_data("captures/ciclop_bust_and_pattern"), folder);
  const CaptureFrames frames(capture);
  Look real;
  look_at(frames.lit(0), frames.dark(0), capture.stripe, real);
  const Rig& rig = capture.rig;
  const SimulateOptions options =
      read_conditions(shipped_data("conditions/ciclop_bust.toml"), rig, options_for(rig));
  SceneObject bust = box_at({0, 0, 0.06}, {1, 1, 1});
  bust.shape = SphereShape{0.06};
  const Scene scene = scene_with({bust});
  const FrameRenderer renderer(scene, rig, options);
  const RigidTransform pose = rig.axis.scan_from_camera_at(0);
  Look simulated;
  look_at(
      renderer.render(pose, true, 0), renderer.render(pose, false, 0), capture.stripe, simulated);
  compare("bust", real, simulated);
  const auto share = [](const Look& look) {
    return look.clipped / (look.clipped + static_cast<double>(look.width.size()));
  };
  EXPECT_NEAR(share(simulated), share(real), 0.15);
}

}  // namespace
}  // namespace facula
