// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/blais_rioux.hpp>
#include <facula/acquire/stripe/detector_table.hpp>
#include <facula/acquire/stripe/peak_shape.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/acquire/stripe/threshold_crossings.hpp>
#include <facula/tests/acquire/stripe/position_errors.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A clean line: no noise, no background; 250 rows a hundredth of a pixel apart.
LineImage clean_line(double sigma) {
  LineImage line;
  line.rows = 250;
  line.sigma = sigma;
  line.noise = 0;
  line.background = 20;
  line.position = [](int r) { return 58.75 + 0.01 * r; };
  return line;
}

StripeOptions options_for(const std::string& name, double sigma) {
  StripeOptions options;
  options.detector = detector_from_name(name);
  options.sigma = sigma;
  return options;
}

StripeProfile found_in(const LineImage& line, const std::string& name) {
  return detect_stripe(draw(line).view(), {}, options_for(name, line.sigma));
}

PositionErrors errors_in(const LineImage& line, const std::string& name) {
  PositionErrors errors;
  add_errors(line, found_in(line, name), {}, errors);
  return errors;
}

class EveryDetector : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Stripe,
                         EveryDetector,
                         testing::ValuesIn(detector_names()),
                         [](const auto& each) {
                           std::string name = each.param;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

/// The brightest pixel rounds to whole pixels, and the middle of an even number of them downwards.
TEST_P(EveryDetector, FindsACleanLineWithinAPixelOfRounding) {
  for (const double sigma : {1.0, 2.0, 4.0}) {
    const PositionErrors e = errors_in(clean_line(sigma), GetParam());
    EXPECT_EQ(e.seen, 250) << sigma;
    EXPECT_LT(e.worst, GetParam() == "brightest" ? 1.0 : 0.51) << sigma;
    EXPECT_LT(std::abs(e.bias()), GetParam() == "brightest" ? 0.06 : 0.02) << sigma;
  }
}

TEST_P(EveryDetector, MeasuresHeightWidthAndLevel) {
  for (const double sigma : {1.5, 2.5}) {
    const LineImage line = clean_line(sigma);
    const StripeProfile profile = found_in(line, GetParam());
    const double peak = 200 * line_in_pixel(sigma, 0, 0);  // the brightest pixel cannot reach 200
    EXPECT_NEAR(static_cast<double>(profile.amplitude[125]), 0.5 * (200 + peak), 6) << sigma;
    EXPECT_NEAR(static_cast<double>(profile.width[125]), std::sqrt(sigma * sigma + 1.0 / 12), 0.1)
        << sigma;
    const StripeSignal signal(draw(line).view(), {}, Channel::kGrey, false);
    const auto found = make_detector(options_for(GetParam(), sigma))->measure(signal, 125, 60);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(static_cast<double>(found->background), 20, 0.5);
    EXPECT_GT(found->snr_per_noise, 0);
    EXPECT_GT(found->sigma_per_noise, 0);
    EXPECT_FALSE(found->saturated);
  }
}

/// Noise is carried by the detector's own formula: reduced chi2 about 1. The three-point detectors
/// are linear only where the bend over three pixels stands out from the noise, as here.
TEST_P(EveryDetector, StatesAnHonestSigmaOnALevelLine) {
  LineImage line;
  line.rows = 4000;
  line.sigma = 1.5;
  line.noise = 2;
  line.position = [](int r) { return 55 + 0.00237 * r; };
  const PositionErrors e = errors_in(line, GetParam());
  EXPECT_EQ(e.seen, 4000);
  EXPECT_GT(e.chi2(), 0.75);
  EXPECT_LT(e.chi2(), 1.25);
}

TEST_P(EveryDetector, CountsPhotonNoise) {
  LineImage line;
  line.rows = 4000;
  line.cols = 200;
  line.sigma = 1.5;
  line.noise = 1;
  line.photons = 0.1;
  line.position = [](int r) { return 95 + 0.00237 * r; };
  const PositionErrors e = errors_in(line, GetParam());
  EXPECT_GT(e.chi2(), 0.75);
  EXPECT_LT(e.chi2(), 1.4);
}

TEST_P(EveryDetector, ReadsColumnsAsItReadsRows) {
  LineImage line;
  line.rows = 200;
  const Image8 upright = draw(line);
  Image8 level(upright.cols, upright.rows);
  for (int r = 0; r < level.rows; ++r) {
    for (int c = 0; c < level.cols; ++c) level.row(r)[c] = upright.row(c)[r];
  }
  StripeOptions options = options_for(GetParam(), line.sigma);
  const StripeProfile per_row = detect_stripe(upright.view(), {}, options);
  options.direction = StripeDirection::kPerColumn;
  const StripeProfile per_column = detect_stripe(level.view(), {}, options);
  EXPECT_GT(per_row.seen_count(), 190U);
  EXPECT_EQ(per_row.seen, per_column.seen);
  EXPECT_EQ(per_row.position, per_column.position);
  EXPECT_EQ(per_row.sigma, per_column.sigma);
}

TEST_P(EveryDetector, SearchesOnlyTheRegion) {
  LineImage line;
  const Image8 image = draw(line);
  StripeOptions options = options_for(GetParam(), line.sigma);
  const StripeProfile whole = detect_stripe(image.view(), {}, options);
  options.region = {.x = 40, .y = 50, .width = 50, .height = 100};
  const StripeProfile part = detect_stripe(image.view(), {}, options);
  for (std::size_t r = 0; r < part.size(); ++r) {
    const bool inside = r >= 50 && r < 150;
    EXPECT_EQ(part.seen[r], inside ? whole.seen[r] : 0) << r;
    if (part.seen[r] != 0) {
      EXPECT_EQ(part.position[r], whole.position[r]) << r;
    }
  }
  options.region = {.x = 0, .y = 0, .width = 30, .height = 0};
  EXPECT_EQ(detect_stripe(image.view(), {}, options).seen_count(), 0U);
}

TEST_P(EveryDetector, SeesNothingInFlatRowsAndNoise) {
  LineImage line;
  line.rows = 500;
  line.cols = 300;
  line.amplitude = 0;
  for (const double noise : {0.0, 3.0}) {
    line.noise = noise;
    EXPECT_EQ(found_in(line, GetParam()).seen_count(), 0U) << noise;
  }
  Image8 white(50, 60);
  std::fill(white.pixels.begin(), white.pixels.end(), std::uint8_t{255});
  EXPECT_EQ(detect_stripe(white.view(), {}, options_for(GetParam(), 2)).seen_count(), 0U);
}

TEST_P(EveryDetector, SurvivesTinyImages) {
  for (const int cols : {1, 2, 3, 5, 9}) {
    for (const int rows : {1, 2, 7}) {
      Image8 image(rows, cols);
      for (int r = 0; r < rows; ++r) image.row(r)[cols / 2] = 200;
      StripeOptions options = options_for(GetParam(), 0.5);
      options.min_run = 1;
      const StripeProfile profile = detect_stripe(image.view(), {}, options);
      for (std::size_t r = 0; r < profile.size(); ++r) {
        if (profile.seen[r] == 0) continue;
        EXPECT_GE(profile.position[r], -0.5F);
        EXPECT_LE(profile.position[r], static_cast<float>(cols) - 0.5F);
      }
    }
  }
}

/// A line that runs out of the frame: what is found lies within, and no number is missing.
TEST_P(EveryDetector, KeepsItsNumbersAtTheBorders) {
  for (const bool right : {false, true}) {
    LineImage line;
    line.rows = 200;
    line.cols = 60;
    line.position = [right](int r) { return right ? 50 + 0.06 * r : 10 - 0.06 * r; };
    const StripeProfile profile = found_in(line, GetParam());
    EXPECT_GT(profile.seen_count(), 20U);
    for (std::size_t r = 0; r < profile.size(); ++r) {
      if (profile.seen[r] == 0) continue;
      EXPECT_TRUE(std::isfinite(profile.position[r]) && profile.position[r] >= -0.5F &&
                  profile.position[r] <= 59.5F)
          << r << " " << profile.position[r];
      EXPECT_TRUE(std::isfinite(profile.sigma[r]) && profile.sigma[r] > 0) << r;
      EXPECT_TRUE(std::isfinite(profile.amplitude[r]) && std::isfinite(profile.width[r])) << r;
    }
  }
}

/// Three-point detectors have no top to read where the core is clipped, and say so by not seeing
/// the row; the others say that it is clipped. Blais-Rioux needs a line that is not wider than its
/// taps.
TEST_P(EveryDetector, SaysWhereTheCoreIsClipped) {
  LineImage line = clean_line(2);
  line.amplitude = 800;
  const StripeProfile profile = found_in(line, GetParam());
  if (GetParam() == "parabola" || GetParam() == "gauss") {
    EXPECT_EQ(profile.seen_count(), 0U);
    return;
  }
  ASSERT_EQ(profile.seen_count(), 250U);
  PositionErrors errors;
  add_errors(line, profile, {}, errors);
  EXPECT_LT(errors.worst, GetParam() == "blais-rioux-4" ? 1.5 : 1.0);
  for (const std::uint8_t s : profile.saturated) EXPECT_EQ(s, 1);
}

/// All but the two-dimensional one.
TEST_P(EveryDetector, MeasuresEachRowByItself) {
  if (GetParam() == "steger") return;
  LineImage line;
  line.rows = 20;
  const Image8 image = draw(line);
  Image8 changed = image;
  for (int r = 0; r < 20; r += 2) std::fill_n(changed.row(r), line.cols, std::uint8_t{10});
  const StripeSignal a(image.view(), {}, Channel::kGrey, false);
  const StripeSignal b(changed.view(), {}, Channel::kGrey, false);
  const auto detector = make_detector(options_for(GetParam(), 2));
  EXPECT_EQ(detector->measure(a, 7, 60)->position, detector->measure(b, 7, 60)->position);
}

/// Positions in steps of 1 / steps px, and the steps' own standard deviation.
void expect_steps(const std::string& name, int steps, std::pair<double, double> spread) {
  for (const double sigma : {1.3, 2.1}) {
    LineImage line = clean_line(sigma);
    line.rows = 2000;
    line.position = [](int r) { return 60 + 0.001 * r; };
    const StripeProfile profile = found_in(line, name);
    for (const float position : profile.position) {
      EXPECT_EQ(position * static_cast<float>(steps),
                std::round(position * static_cast<float>(steps)));
    }
    PositionErrors errors;
    add_errors(line, profile, {}, errors);
    EXPECT_GT(errors.rms(), spread.first) << sigma;
    EXPECT_LT(errors.rms(), spread.second) << sigma;
    EXPECT_NEAR(errors.chi2(), 1, 0.25) << sigma;
  }
}

TEST(StripeDetectors, ThresholdDetectorsStepAsTheSourceSays) {
  expect_steps("brightest", 1, {0.28, 0.30});
  expect_steps("one-threshold", 2, {1 / (2 * std::sqrt(12.0)) - 0.01, 1 / std::sqrt(12.0) + 0.01});
  expect_steps("two-thresholds", 4, {1 / (4 * std::sqrt(12.0)) - 0.01, 0.20});
}

TEST(StripeDetectors, StepVarianceMatchesItsEnds) {
  EXPECT_NEAR(step_variance({0.3}), 1.0 / 12, 1e-12);
  EXPECT_NEAR(step_variance({0.3, 5.3}), 1.0 / 12, 1e-12);
  EXPECT_NEAR(step_variance({0.3, -0.2}), 1.0 / 48, 1e-12);
  EXPECT_NEAR(step_variance({0.1, 0.35, 0.6, 0.85}), 1.0 / (12 * 16), 1e-12);
  EXPECT_NEAR(step_variance({0, 0.25}), (1 - 0.75 + 3 * 0.0625) / 12, 1e-12);
}

/// E sinh(pu) / (2 (1 - E cosh(pu))) - p for the sampled Gaussian; pixels integrate here, which
/// widens it by 1/12 px^2.
TEST(StripeDetectors, ParabolaFollowsItsClosedSCurve) {
  for (const double sigma : {1.0, 1.5}) {
    const LineImage line = clean_line(sigma);
    const StripeProfile profile = found_in(line, "parabola");
    const double u = 1 / (sigma * sigma + 1.0 / 12);
    const double e = std::exp(-0.5 * u);
    for (int r = 0; r < line.rows; ++r) {
      const double p = line.position(r) - std::round(line.position(r));
      if (std::abs(p) > 0.45) continue;  // rounding may choose the other neighbour
      const double bias = e * std::sinh(p * u) / (2 * (1 - e * std::cosh(p * u))) - p;
      const double error =
          static_cast<double>(profile.position[static_cast<std::size_t>(r)]) - line.position(r);
      EXPECT_NEAR(error, bias, 0.012) << sigma << " " << p;
    }
  }
}

TEST(StripeDetectors, GaussAndLogGaussFollowAGaussianWithoutBias) {
  for (const char* name : {"gauss", "log-gauss"}) {
    const PositionErrors e = errors_in(clean_line(1), name);
    EXPECT_LT(e.rms(), 0.006) << name;  // the rounding to whole DN
  }
}

/// Antisymmetric kernels are exact at pixel middles and half way between.
TEST(StripeDetectors, BlaisRiouxIsExactAtTheSymmetricPlaces) {
  for (const char* name : {"blais-rioux-4", "blais-rioux-8"}) {
    for (const double place : {60.0, 60.5}) {
      LineImage line = clean_line(1.2);
      line.rows = 10;
      line.position = [place](int) { return place; };
      for (const float position : found_in(line, name).position) {
        EXPECT_NEAR(static_cast<double>(position), place, 1e-5) << name;
      }
    }
  }
  EXPECT_NE(error_of([] { make_blais_rioux(2, 5); }).find("even number of taps"),
            std::string::npos);
}

/// sum I x / sum I over a window that holds the whole line is the line's middle, whatever its
/// shape.
TEST(StripeDetectors, CentroidIsExactForAWholeWindow) {
  EXPECT_LT(errors_in(clean_line(1.5), "centroid").rms(), 0.012);
  // Two overlapping lines of unequal height: the mean of both by their weights.
  LineImage line = clean_line(1.2);
  line.second_offset = 3;
  line.second_share = [](int) { return 0.3; };
  // A wider line is expected, so that the level is taken beyond the second one.
  const StripeProfile profile = detect_stripe(draw(line).view(), {}, options_for("centroid", 2.5));
  for (int r = 0; r < line.rows; ++r) {
    EXPECT_NEAR(static_cast<double>(profile.position[static_cast<std::size_t>(r)]),
                line.position(r) + 0.3 * 3,
                0.06);
  }
}

/// Negative heights count: noise beside the line does not pull the mean to the window's middle.
TEST(StripeDetectors, CentroidIsNotPulledByClippedNoise) {
  LineImage line;
  line.rows = 4000;
  line.sigma = 1.5;
  line.amplitude = 100;
  line.noise = 3;
  line.position = [](int) { return 60.4; };
  const PositionErrors e = errors_in(line, "centroid");
  EXPECT_LT(std::abs(e.bias()), 4 * e.rms() / std::sqrt(4000.0));
}

/// Steger's ridge is as quiet as 2 sqrt(pi) sigma rows of light allow, and keeps to a leaning line.
TEST(StripeDetectors, StegerFollowsALeaningLineAndUsesItsNeighbours) {
  LineImage line;
  line.rows = 300;
  line.cols = 400;
  line.position = [](int r) { return 60 + 0.9 * r; };
  PositionErrors steger;
  const auto inside = [](int r) { return r > 10 && r < 290; };
  add_errors(line, found_in(line, "steger"), inside, steger);
  PositionErrors fir;
  add_errors(line, found_in(line, "fir"), inside, fir);
  EXPECT_EQ(steger.seen, 279);
  EXPECT_LT(std::abs(steger.bias()), 0.003);
  EXPECT_LT(steger.rms(), 0.75 * fir.rms());
}

TEST(StripeDetectors, ThresholdCentroidAndMaximumKeepToTheThreshold) {
  LineImage line = clean_line(2);
  line.amplitude = 30;
  for (const char* name : {"maximum", "threshold-centroid"}) {
    StripeOptions options = options_for(name, 2);
    const Image8 image = draw(line);
    options.min_amplitude = 25;
    EXPECT_EQ(detect_stripe(image.view(), {}, options).seen_count(), 250U) << name;
    options.min_amplitude = 35;
    EXPECT_EQ(detect_stripe(image.view(), {}, options).seen_count(), 0U) << name;
  }
}

TEST(StripeDetectors, MisfitOfAGaussianLineIsTheNoiseWhereverTheCandidateLies) {
  LineImage line;
  line.rows = 4000;
  line.noise = 3;
  line.position = [](int) { return 60.3; };
  const StripeSignal signal(draw(line).view(), {}, Channel::kGrey, false);
  for (const float off : {0.0F, 0.3F, -0.4F}) {
    double mean = 0;
    for (int r = 0; r < line.rows; ++r) {
      StripeCandidate found;
      found.position = 60.3F + off;
      found.width = 2.0F;
      found.background = 10;
      measure_misfit(signal.row(r), found);
      mean += static_cast<double>(found.residual) / line.rows;
    }
    // 9 degrees of freedom, 4000 rows: 0.75 % of standard deviation; misplacing leaves second
    // order.
    EXPECT_NEAR(mean / (9 + 1.0 / 12), 1, off == 0 ? 0.03 : 0.45) << off;
  }
}

TEST(StripeDetectors, NamesAreKnownAndUnknownOnesListed) {
  for (const std::string& name : detector_names()) {
    EXPECT_EQ(to_string(detector_from_name(name)), name);
  }
  EXPECT_EQ(detector_names().front(), to_string(StripeOptions{}.detector));
  const std::string error = error_of([] { detector_from_name("fur"); });
  for (const std::string& name : detector_names()) {
    EXPECT_NE(error.find(name), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace facula
