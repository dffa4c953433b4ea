// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/lens.hpp>
#include <facula/tests/acquire/simulate/line_moments.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(Lens, BlurWeightsHaveTheVarianceAskedFor) {
  for (const double sigma : {0.0, 0.05, 0.3, 0.8, 2.0, 25.0}) {
    const std::vector<double> weights = blur_weights(sigma);
    double sum = weights[0];
    double variance = 0;
    for (std::size_t n = 1; n < weights.size(); ++n) {
      sum += 2 * weights[n];
      variance += 2 * weights[n] * static_cast<double>(n * n);
    }
    EXPECT_NEAR(sum, 1, 1e-12) << sigma;
    EXPECT_NEAR(variance, sigma * sigma, 1e-6 * sigma * sigma) << sigma;
  }
}

TEST(Lens, BlurAddsItsVarianceToTheLineAndLosesNoLight) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  const Moments sharp = moments(light_on_wall(rig, options), 60);
  for (const double blur : {0.3, 1.0, 3.0}) {
    options.lens.blur = blur;
    const Moments soft = moments(light_on_wall(rig, options), 60);
    EXPECT_NEAR(soft.variance, sharp.variance + blur * blur, 0.001 * soft.variance);
    EXPECT_NEAR(soft.sum, sharp.sum, 1e-4 * sharp.sum);
    EXPECT_NEAR(soft.position, sharp.position, 1e-3);
  }
}

// A line of 0.1 to 0.4 px lies anywhere within a pixel; the lens must find it where it is.
TEST(Lens, KeepsThePlaceOfALineThinnerThanAPixel) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.lens.blur = 1.5;
  for (const double sigma : {0.1, 0.2, 0.4}) {
    options.line_divergence = 0;
    options.line_half_width = sigma / 600 * 2;
    for (const double depth : {1.95, 1.96, 1.97, 1.98, 1.99, 2.0}) {
      const PolarScan truth = true_scan(scene_with({wall_at(depth)}), rig, {}, {0.0}, options);
      const Eigen::Vector3d x = truth.point[truth.index(60, 0)].cast<double>();
      const Moments seen = moments(light_on_wall(rig, options, depth), 60);
      EXPECT_NEAR(seen.position, rig.camera.project(x).x(), 0.015) << sigma << " at " << depth;
      EXPECT_NEAR(seen.variance, 1.5 * 1.5 + 1.0 / 12 + sigma * sigma, 0.03) << sigma;
    }
  }
}

TEST(Lens, GlareMovesItsShareAway) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  const double sharp = light_on_wall(rig, options).row(60)[120];
  options.lens.glare_share = 0.1;
  options.lens.glare_blur = 10;
  const Image<double> image = light_on_wall(rig, options);
  const double line = moments(light_on_wall(rig, quiet_options(rig)), 60).sum;
  const auto wing = [&](double x) {
    return 0.1 * line * std::exp(-x * x / 200) / (10 * std::sqrt(2 * std::numbers::pi));
  };
  EXPECT_NEAR(image.row(60)[120], 0.9 * sharp + wing(0), 0.02 * sharp);
  EXPECT_NEAR(image.row(60)[140], wing(20), 0.05 * wing(20));
}

TEST(Lens, VignettingFollowsThePowerOfTheCosine) {
  const Rig rig = small_head();
  SimulateOptions options = quiet_options(rig);
  options.ambient = 100;
  options.lens.vignetting = 4;
  const Scene scene = scene_with({wall_at(2)});
  const Image<double> image = FrameRenderer(scene, rig, options).expected_signal({}, false);
  for (const int c : {0, 120, 239}) {
    const double cosine = 1 / std::sqrt(1 + (std::pow(c - 119.5, 2) + std::pow(0.5, 2)) / 360000.0);
    EXPECT_NEAR(image.row(60)[c], 80 * std::pow(cosine, 4), 1e-9);
  }
}

}  // namespace
}  // namespace facula
