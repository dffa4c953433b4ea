// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/frame_renderer.hpp>
#include <facula/acquire/simulate/speckle_field.hpp>
#include <facula/tests/acquire/simulate/line_moments.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

namespace facula {
namespace {

using Eigen::Vector3d;

// A sheet that bows by b meets a wall square to its axis on a curve: with the light's origin at
// depth 0, the plane n.x = d turned into the cone h = tan(b) (sqrt(p^2 + q^2) - p), q = y across
// the fan and p along its middle. The wall at depth z is met where both hold; solved here by
// iteration.
double bowed_column(const Rig& rig, double depth, int r) {
  const double nx = rig.lasers[0].normal.x();
  const double nz = rig.lasers[0].normal.z();
  const double y = (r - rig.camera.cy) / rig.camera.fy * depth;
  const double bend = std::tan(rig.lasers[0].bow);
  double x = 0;
  for (int i = 0; i < 50; ++i) {
    const double p = depth * nx - (x - 0.25 / nx) * nz;  // along the middle of the fan
    const double height = bend * (std::hypot(p, y) - p);
    x = (0.25 + height - nz * depth) / nx;
  }
  return rig.camera.cx + rig.camera.fx * x / depth;
}

TEST(LaserBow, BendsTheLineAsTheConeMeetsTheWall) {
  Rig rig = small_head();
  rig.camera.height = 360;
  rig.camera.cy = 179.5;
  for (const double bow : {0.02, -0.05}) {
    rig.lasers[0].bow = bow;
    const Image<double> image = light_on_wall(rig, quiet_options(rig));
    for (const int r : {0, 60, 180, 300, 359}) {
      EXPECT_NEAR(moments(image, r).position, bowed_column(rig, 2.0, r), 0.01) << bow << ' ' << r;
    }
    EXPECT_GT(std::abs(bowed_column(rig, 2.0, 0) - bowed_column(rig, 2.0, 180)), 0.5);
  }
}

TEST(LaserBow, IsTheConeThatTheRigDefines) {
  Rig rig = small_head();
  rig.camera.height = 360;
  rig.camera.cy = 179.5;
  rig.lasers[0].bow = 0.04;
  const PolarScan truth = true_scan(scene_with({wall_at(1.8)}), rig, {}, {0.0}, quiet_options(rig));
  ASSERT_EQ(truth.valid_count(), 360U);
  for (const Eigen::Vector3f& point : truth.point) {
    EXPECT_NEAR(rig.lasers[0].sheet_distance(point.cast<double>()), 0, 5e-7);
  }
  // The fan's rays, from the other side.
  const LaserFan fan = laser_fan(rig, quiet_options(rig));
  for (const double angle : {-1.2, -0.3, 0.0, 0.5, 1.0}) {
    EXPECT_NEAR(rig.lasers[0].sheet_distance(fan.origin + 2.5 * fan.ray(angle)), 0, 1e-12);
    EXPECT_NEAR(fan.sheet_distance(fan.origin + 2.5 * fan.ray(angle)), 0, 1e-12);
  }
}

TEST(GaussianBeam, IsSqrtTwoWiderOneRayleighLengthFromItsWaist) {
  GaussianBeam beam;
  const double rayleigh = std::numbers::pi * beam.waist * beam.waist / beam.wavelength;
  EXPECT_NEAR(beam.half_width(beam.focus), beam.waist / 2, 1e-12);
  EXPECT_NEAR(beam.half_width(beam.focus + rayleigh), beam.waist / std::sqrt(2.0), 1e-12);
  // Far away it opens by lambda / (pi waist) to 1/e^2.
  EXPECT_NEAR(
      beam.half_width(1e4) / 1e4, 0.5 * beam.wavelength / (std::numbers::pi * beam.waist), 1e-7);
}

TEST(GaussianBeam, GivesTheLineItsWidth) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.beam = GaussianBeam{.waist = 400e-6, .focus = 0.5, .wavelength = 650e-9, .quality = 20};
  for (const double depth : {1.7, 2.3}) {
    const double nx = rig.lasers[0].normal.x();
    const double x = (0.25 - rig.lasers[0].normal.z() * depth) / nx;
    const double y = (60 - rig.camera.cy) / 600 * depth;
    const double r = (Vector3d(0.25 / nx, 0, 0) - Vector3d(x, y, depth)).norm();
    const double sigma = 600 / depth * options.beam->half_width(r) / nx;
    EXPECT_NEAR(moments(light_on_wall(rig, options, depth), 60).variance,
                sigma * sigma + 1.0 / 12,
                0.005 * sigma * sigma);
  }
}

// Contrast and correlation of a field against the formulas that the options state.
void expect_speckle(const Speckle& speckle) {
  const Image<double> field = speckle_field(400, 400, speckle, 7);
  const auto n = static_cast<double>(field.pixels.size());
  const double mean = std::accumulate(field.pixels.begin(), field.pixels.end(), 0.0) / n;
  double variance = 0;
  double neighbours = 0;
  for (int r = 0; r + 1 < field.rows; ++r) {
    for (int c = 0; c + 1 < field.cols; ++c) {
      const double here = field.row(r)[c] - mean;
      variance += here * here;
      neighbours += 0.5 * here * (field.row(r)[c + 1] - mean + field.row(r + 1)[c] - mean);
    }
  }
  EXPECT_NEAR(mean, 1, 0.02);
  EXPECT_NEAR(std::sqrt(variance / n), speckle.contrast(), 0.03 * speckle.contrast());
  EXPECT_NEAR(neighbours / variance, speckle.correlation(1), 0.02);
}

TEST(Speckle, HasTheContrastAndTheCorrelationOfTheFormulas) {
  expect_speckle({.f_number = 2.8, .pixel_pitch = 3e-6, .averages = 2});
  expect_speckle({.f_number = 16, .pixel_pitch = 3e-6, .averages = 1});
  expect_speckle({.f_number = 8, .pixel_pitch = 6e-6, .averages = 3.5});
}

// Goodman (2007), 4.6: grains much smaller than a pixel, with area (4/pi) (lambda N)^2, leave the
// contrast sqrt(grain area / pixel area); grains much larger leave it at 1.
TEST(Speckle, TendsToTheKnownLimits) {
  const Speckle fine{.wavelength = 650e-9, .f_number = 2, .pixel_pitch = 40e-6, .averages = 1};
  const double grain = 650e-9 * 2 * std::sqrt(4 / std::numbers::pi);
  EXPECT_NEAR(fine.contrast(), grain / 40e-6, 0.02 * grain / 40e-6);
  EXPECT_LT(fine.correlation(1), 0.02);
  const Speckle coarse{.wavelength = 650e-9, .f_number = 64, .pixel_pitch = 2e-6, .averages = 1};
  EXPECT_NEAR(coarse.contrast(), 1, 0.01);
  EXPECT_GT(coarse.correlation(1), 0.98);
}

// Goodman's number of cells of a square pixel and a Gaussian correlation (2007, 4.6), in closed
// form with erf, against the quadrature of the options.
TEST(Speckle, ContrastIsGoodmansNumberOfCells) {
  for (const double f_number : {1.4, 4.0, 11.0, 32.0}) {
    const Speckle speckle{.f_number = f_number, .pixel_pitch = 5e-6, .averages = 1};
    const double ratio = 4 / std::numbers::pi * std::pow(speckle.grain(), 2);  // grain over pixel
    const double root = std::sqrt(std::numbers::pi / ratio);
    const double per_direction =
        std::sqrt(ratio) * std::erf(root) -
        ratio / std::numbers::pi * (1 - std::exp(-std::numbers::pi / ratio));
    EXPECT_NEAR(speckle.contrast(), per_direction, 1e-6) << f_number;
  }
}

// Grains that are independent from pixel to pixel, contrast C, move the centre of gravity of a
// Gaussian line by C sqrt(sigma / (4 sqrt(pi))) px RMS.
TEST(Speckle, ShakesTheCentreOfGravityByTheClosedForm) {
  Rig rig = small_head();
  rig.camera.height = 600;
  rig.camera.cy = 299.5;
  SimulateOptions options = quiet_options(rig);
  options.exposure_falloff = 0;
  const Image<double> still = light_on_wall(rig, options);
  options.speckle =
      Speckle{.wavelength = 650e-9, .f_number = 2, .pixel_pitch = 10e-6, .averages = 1};
  const Image<double> grainy = light_on_wall(rig, options);
  double square = 0;
  double sigma = 0;
  for (int r = 0; r < grainy.rows; ++r) {
    square += std::pow(moments(grainy, r).position - moments(still, r).position, 2) / grainy.rows;
    sigma += std::sqrt(moments(still, r).variance) / grainy.rows;
  }
  const double expected =
      options.speckle->contrast() * std::sqrt(sigma / (4 * std::sqrt(std::numbers::pi)));
  EXPECT_NEAR(std::sqrt(square), expected, 0.08 * expected);
}

TEST(Speckle, StaysWithThePoseAndLeavesAmbientLightAlone) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.ambient = 50;
  options.speckle = Speckle{};
  const Scene scene = scene_with({wall_at(2)});
  const FrameRenderer renderer(scene, rig, options);
  EXPECT_EQ(renderer.expected_signal({}, true).pixels, renderer.expected_signal({}, true).pixels);
  RigidTransform moved;
  moved.translation.y() = 1e-4;
  EXPECT_NE(renderer.expected_signal(moved, true).row(60)[120],
            renderer.expected_signal({}, true).row(60)[120]);
  EXPECT_NEAR(renderer.expected_signal({}, true).row(60)[5], 40, 1e-9);
}

TEST(Flicker, FollowsTheMainsAndShrinksWithTheExposure) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.ambient = 100;
  options.flicker = {.depth = 0.3, .frequency = 100, .phase = 0.4};
  options.timing = {.frame_interval = 0.0313, .exposure_time = 0.004, .row_time = 2e-5};
  options.background_frames = options.second_background = true;
  const Scene scene = scene_with({wall_at(2)});
  const FrameRenderer renderer(scene, rig, options);
  const double turn = std::numbers::pi * 100 * 0.004;
  const double swing = 0.3 * std::sin(turn) / turn;
  for (std::uint64_t step = 0; step < 5; ++step) {
    for (const bool after : {false, true}) {
      const Exposure exposure{.laser_on = false, .step = step, .after = after};
      // dark, lit, dark again: exposures 3 step and 3 step + 2
      const double t = static_cast<double>(3 * step + (after ? 2 : 0)) * 0.0313 + 40 * 2e-5;
      const double expected = 80 * (1 + swing * std::cos(2 * std::numbers::pi * 100 * t + 0.4));
      EXPECT_NEAR(renderer.expected_signal({}, exposure).row(40)[7], expected, 1e-9);
    }
  }
}

TEST(Colour, SurfacesLampsAndLaserShowTheirChannels) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.ambient = 100;
  options.colour_frames = true;
  SceneObject wall = wall_at(2);
  wall.colour = {1.0, 0.5, 0.25};
  wall.glow = 20;
  const Scene scene = scene_with({wall});
  const FrameRenderer renderer(scene, rig, options);
  const Image<double> dark = renderer.expected_signal({}, false);
  ASSERT_EQ(dark.channels, 3);
  const double* pixel = dark.row(60) + 3 * 30;  // blue, green, red
  EXPECT_NEAR(pixel[0], 0.25 * 100, 1e-9);
  EXPECT_NEAR(pixel[1], 0.5 * 100, 1e-9);
  EXPECT_NEAR(pixel[2], 100, 1e-9);
  SimulateOptions grey = quiet_options(rig);
  const double line = moments(light_on_wall(rig, grey), 60).sum;
  for (const LaserColour colour : {LaserColour::kRed, LaserColour::kGreen}) {
    options.laser_colour = colour;
    const Image<double> lit = FrameRenderer(scene, rig, options).expected_signal({}, true);
    const int own = colour == LaserColour::kRed ? 2 : 1;
    double sum[3] = {};
    for (int i = 0; i < 3 * lit.cols; ++i) sum[i % 3] += lit.row(60)[i] - dark.row(60)[i];
    EXPECT_NEAR(sum[own], line * (own == 2 ? 1.0 : 0.5), 1e-6 * line);
    EXPECT_GT(sum[own], 3 * sum[0]);
  }
}

// A mirror square to nothing: it lies below the line of sight and throws the lower part of the fan
// onto the wall. The second line's place is worked out ray by ray from the fan.
TEST(Mirror, ThrowsASecondLineWhereReflectedRaysMeetTheWall) {
  Rig rig = small_head();
  rig.camera.width = 400;
  rig.camera.cx = 199.5;
  rig.camera.height = 300;
  rig.camera.cy = 149.5;
  const SimulateOptions options = quiet_options(rig);
  SceneObject wall = wall_at(2);
  SceneObject mirror = box_at({0.1, 0.35, 1.4}, {0.5, 0.02, 0.4});
  mirror.world_from_object.rotation = Eigen::AngleAxisd(0.3, Vector3d(1, 0, 0.4).normalized());
  mirror.albedo = 0;
  mirror.mirror = 0.6;
  const Scene scene = scene_with({wall, mirror});
  SceneObject black = mirror;
  black.mirror = 0;
  const Scene without = scene_with({wall, black});
  Image<double> thrown = FrameRenderer(scene, rig, options).expected_signal({}, true);
  const Image<double> direct = FrameRenderer(without, rig, options).expected_signal({}, true);
  for (std::size_t i = 0; i < thrown.pixels.size(); ++i) thrown.pixels[i] -= direct.pixels[i];
  const LaserFan fan = laser_fan(rig, options);
  int met = 0;
  for (int i = 0; i < 40000; ++i) {
    const Vector3d direction = fan.ray(-0.5 + 2.5e-5 * i);
    const auto first = scene.first_hit(fan.origin, direction);
    if (!first || first->object != 1) continue;
    const Vector3d onwards = direction - 2 * direction.dot(first->normal) * first->normal;
    const auto second = scene.first_hit(first->point, onwards);
    if (!second || second->object != 0 || scene.occluded({0, 0, 0}, second->point)) continue;
    const Eigen::Vector2d pixel = rig.camera.project(second->point);
    const int r = static_cast<int>(std::round(pixel.y()));
    const int c = static_cast<int>(std::round(pixel.x()));
    if (std::abs(pixel.y() - r) > 0.01 || r < 5 || r > 200 || c < 20 || c > 380) continue;
    // The line lies oblique and grows wider along the row: its centre of gravity is not its middle
    // by some hundredths of a pixel.
    EXPECT_NEAR(moments(thrown, r, c - 15, c + 16).position, pixel.x(), 0.08) << r;
    // As bright as the way by the mirror is long: the laser's image shines on the wall.
    const double way = first->distance + second->distance;
    const double width = fan.half_width(way);
    const double peak =
        0.8 * 0.6 * fan.peak * fan.half_width(1) / width * std::abs(second->normal.dot(onwards));
    EXPECT_NEAR(thrown.row(r)[c], peak, 0.1 * peak) << r;
    ++met;
  }
  EXPECT_GT(met, 50);
}

// In a mirror that stands square to the axis the camera sees itself from behind: a wall 1 m behind
// the camera looks like a wall 2 * depth + 1 m ahead, times the mirror's share.
TEST(Mirror, ShowsWhatStandsBehindTheCamera) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.ambient = 100;
  SceneObject mirror = wall_at(2);
  mirror.albedo = 0.1;
  mirror.mirror = 0.7;
  const Scene scene = scene_with({mirror, box_at({0, 0, -1.5}, {20, 20, 1})});
  const Image<double> image = FrameRenderer(scene, rig, options).expected_signal({}, false);
  for (const double signal : image.pixels) EXPECT_NEAR(signal, 10 + 0.7 * 80, 1e-9);
}

TEST(AllLasers, AddTheirLines) {
  Rig rig = small_head();
  rig.lasers[0].name = "right";
  rig.lasers.push_back(rig.lasers[0]);
  rig.lasers[1].name = "left";
  rig.lasers[1].normal.x() *= -1;
  SimulateOptions options = quiet_options(rig);
  options.all_lasers = true;
  const double depth = 1.8;
  const Image<double> both = light_on_wall(rig, options, depth);
  options.all_lasers = false;
  const Image<double> right = light_on_wall(rig, options, depth);
  options.laser = 1;
  options.laser_origin.x() *= -1;
  const Image<double> left = light_on_wall(rig, options, depth);
  for (std::size_t i = 0; i < both.pixels.size(); ++i) {
    ASSERT_NEAR(both.pixels[i], left.pixels[i] + right.pixels[i], 1e-9);
  }
}

}  // namespace
}  // namespace facula
