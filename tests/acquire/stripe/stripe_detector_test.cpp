// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/fir_clipped.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/tests/acquire/stripe/line_image.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

struct Errors {
  double rms = 0;   ///< [px]
  double bias = 0;  ///< [px]
  double chi2 = 0;  ///< mean (error / sigma)^2 [1]
  double seen = 0;  ///< share of rows [1]
};

Errors errors_of(const LineImage& line, StripeOptions options) {
  const Image8 image = draw(line);
  const StripeProfile profile = detect_stripe(image.view(), {}, options);
  Errors e;
  for (int r = 0; r < line.rows; ++r) {
    const auto i = static_cast<std::size_t>(r);
    if (profile.seen[i] == 0) continue;
    const double error = static_cast<double>(profile.position[i]) - line.position(r);
    const double z = error / static_cast<double>(profile.sigma[i]);
    e.rms += error * error;
    e.bias += error;
    e.chi2 += z * z;
    e.seen += 1;
  }
  e.rms = std::sqrt(e.rms / e.seen);
  e.bias /= e.seen;
  e.chi2 /= e.seen;
  e.seen /= line.rows;
  return e;
}

StripeOptions options_for(const LineImage& line) {
  return {.sigma = line.sigma};
}

/// Least standard deviation any unbiased estimate can have: n sqrt(2 s / (A^2 sqrt(pi))).
double cramer_rao(const LineImage& line) {
  const double noise = std::sqrt(line.noise * line.noise + 1.0 / 12);
  return noise * std::sqrt(2 * line.sigma / std::sqrt(std::numbers::pi)) / line.amplitude;
}

TEST(StripeDetector, ReachesTheCramerRaoBoundWithinTenPerCent) {
  for (const double sigma : {2.0, 4.0}) {
    for (const double noise : {2.0, 4.0}) {
      LineImage line;
      line.rows = 4000;
      line.sigma = sigma;
      line.noise = noise;
      line.position = [](int r) { return 60 + 0.00137 * r; };
      const Errors e = errors_of(line, options_for(line));
      EXPECT_EQ(e.seen, 1);
      EXPECT_LT(e.rms, 1.10 * cramer_rao(line)) << "sigma " << sigma << " noise " << noise;
    }
  }
}

TEST(StripeDetector, StatesAnHonestSigma) {
  for (const double noise : {1.0, 2.0, 4.0}) {
    LineImage line;
    line.rows = 4000;
    line.noise = noise;
    const Errors e = errors_of(line, options_for(line));
    EXPECT_GT(e.chi2, 0.8) << "noise " << noise;
    EXPECT_LT(e.chi2, 1.2) << "noise " << noise;
  }
}

TEST(StripeDetector, IsNotShiftedByAClippedCore) {
  LineImage line;
  line.rows = 2000;
  line.amplitude = 800;
  const Errors e = errors_of(line, options_for(line));
  EXPECT_EQ(e.seen, 1);
  EXPECT_LT(e.rms, 0.05);
  EXPECT_LT(std::abs(e.bias), 0.005);
}

/// Slope of the ramp over bend of the line: m / (A s / (2 s^2)^(3/2)) for equal widths.
TEST(StripeDetector, IsShiftedByARampAsItsHeaderSays) {
  LineImage line;
  line.amplitude = 120;
  line.slope = 0.4;
  line.rows = 2000;
  const double bend = 120 * 2 / std::pow(2 * 4.0, 1.5);
  EXPECT_NEAR(errors_of(line, options_for(line)).bias, 0.4 / bend, 0.004);
}

TEST(StripeDetector, MeasuresAmplitudeWidthAndNoise) {
  LineImage line;
  line.sigma = 2.5;
  line.amplitude = 150;
  StripeOptions options = options_for(line);
  options.sigma = 2;  // a filter of another width must still read the line's own
  const StripeProfile profile = detect_stripe(draw(line).view(), {}, options);
  double amplitude = 0;
  double width = 0;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    amplitude += static_cast<double>(profile.amplitude[r]) / 400;
    width += static_cast<double>(profile.width[r]) / 400;
  }
  EXPECT_NEAR(amplitude, 150, 3);
  EXPECT_NEAR(width, std::sqrt(2.5 * 2.5 + 1.0 / 12), 0.05);
  EXPECT_NEAR(static_cast<double>(profile.noise), std::sqrt(4 + 1.0 / 12), 0.15);
  EXPECT_EQ(profile.saturated[0], 0);
}

TEST(StripeDetector, CentroidFindsTheMiddleOfACleanLine) {
  LineImage line;
  line.noise = 0;
  line.background = 0;
  line.rows = 100;
  StripeOptions options = options_for(line);
  options.detector = DetectorKind::kCentroid;
  const Errors e = errors_of(line, options);
  EXPECT_EQ(e.seen, 1);
  EXPECT_LT(e.rms, 0.02);
}

TEST(StripeDetector, SeesNothingInNoiseAlone) {
  for (const double noise : {0.0, 1.0, 4.0, 12.0}) {
    LineImage line;
    line.rows = 2000;
    line.cols = 640;
    line.amplitude = 0;
    line.noise = noise;
    line.background = 40;
    EXPECT_EQ(detect_stripe(draw(line).view(), {}, StripeOptions{}).seen_count(), 0U) << noise;
  }
}

TEST(StripeDetector, LeavesRowsWithoutAStripeUnseen) {
  LineImage line;
  line.amplitude = 120;
  Image8 image = draw(line);
  for (int r = 100; r < 200; ++r) {
    LineImage dark = line;
    dark.amplitude = 0;
    dark.rows = 1;
    dark.seed = static_cast<std::uint64_t>(r);
    const Image8 row = draw(dark);
    std::copy_n(row.row(0), image.cols, image.row(r));
  }
  const StripeProfile profile = detect_stripe(image.view(), {}, StripeOptions{});
  for (std::size_t r = 0; r < profile.size(); ++r) {
    EXPECT_EQ(profile.seen[r], r >= 100 && r < 200 ? 0 : 1) << r;
  }
}

TEST(StripeDetector, ReadsAStripeThatRunsPerColumn) {
  LineImage line;
  line.rows = 200;
  const Image8 upright = draw(line);
  Image8 level(upright.cols, upright.rows);
  for (int r = 0; r < level.rows; ++r) {
    for (int c = 0; c < level.cols; ++c) level.row(r)[c] = upright.row(c)[r];
  }
  StripeOptions options;
  const StripeProfile per_row = detect_stripe(upright.view(), {}, options);
  options.direction = StripeDirection::kPerColumn;
  const StripeProfile per_column = detect_stripe(level.view(), {}, options);
  EXPECT_EQ(per_row.position, per_column.position);
  EXPECT_EQ(per_row.seen, per_column.seen);
}

TEST(StripeDetector, SearchesOnlyTheRegion) {
  LineImage line;
  StripeOptions options;
  options.region = {.x = 0, .y = 50, .width = 0, .height = 100};
  EXPECT_EQ(detect_stripe(draw(line).view(), {}, options).seen_count(), 100U);
  options.region = {.x = 0, .y = 0, .width = 40, .height = 0};
  EXPECT_EQ(detect_stripe(draw(line).view(), {}, options).seen_count(), 0U);
}

TEST(StripeDetector, SubtractsTheBackground) {
  LineImage lit;
  lit.amplitude = 60;
  LineImage lamp = lit;
  lamp.amplitude = 180;  // a brighter line elsewhere, in both frames
  lamp.position = [](int) { return 20.0; };
  lamp.noise = 0;
  const Image8 dark = draw(lamp);
  Image8 image = draw(lit);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<std::uint8_t>(
        std::min(255, static_cast<int>(image.pixels[i]) + static_cast<int>(dark.pixels[i])));
  }
  const StripeProfile with = detect_stripe(image.view(), dark.view(), StripeOptions{});
  const StripeProfile without = detect_stripe(image.view(), {}, StripeOptions{});
  EXPECT_NEAR(static_cast<double>(with.position[100]), lit.position(100), 0.3);
  EXPECT_NEAR(static_cast<double>(without.position[100]), 20, 0.3);
  const Image8 other(10, 10);
  EXPECT_NE(error_of([&] {
              detect_stripe(image.view(), other.view(), StripeOptions{});
            }).find("background of the frame's size"),
            std::string::npos);
}

TEST(StripeDetector, RefusesChannelsItCannotRead) {
  const Image8 colour(20, 20, 3);
  const Image8 grey(20, 20);
  EXPECT_NE(error_of([&] { detect_stripe(Image8(20, 20, 4).view(), {}, {}); }).find("4 channels"),
            std::string::npos);
  EXPECT_NE(error_of([&] { detect_stripe(colour.view(), grey.view(), {}); }).find("both grey"),
            std::string::npos);
  EXPECT_NE(error_of([&] { extract_channel(Image8(9, 9, 2).view(), Channel::kRed); }).find("2 ch"),
            std::string::npos);
}

/// A view of the left part of a wider image: rows lie a stride apart.
TEST(StripeDetector, ReadsAViewByItsStride) {
  LineImage line;
  line.rows = 60;
  const Image8 wide = draw(line);
  Image8 copy(60, 100);
  for (int r = 0; r < 60; ++r) std::copy_n(wide.row(r), 100, copy.row(r));
  const ImageView8 part{wide.view().data, 60, 100, 1, wide.stride()};
  EXPECT_EQ(detect_stripe(part, {}, {}).position, detect_stripe(copy.view(), {}, {}).position);
}

TEST(StripeDetector, ChoosesTheColourChannel) {
  LineImage line;
  const Image8 red = draw(line);
  Image8 image(red.rows, red.cols, 3);
  for (int r = 0; r < red.rows; ++r) {
    for (int c = 0; c < red.cols; ++c) {
      image.row(r)[3 * c + 2] = red.row(r)[c];
      // A white line at column 20: brighter, but not red.
      const int white = std::abs(c - 20) < 3 ? 250 : 0;
      for (int k = 0; k < 3; ++k) {
        image.row(r)[3 * c + k] =
            static_cast<std::uint8_t>(std::max<int>(image.row(r)[3 * c + k], white));
      }
    }
  }
  StripeOptions options;
  options.channel = Channel::kRedExcess;
  EXPECT_NEAR(static_cast<double>(detect_stripe(image.view(), {}, options).position[200]),
              line.position(200),
              0.2);
  options.channel = Channel::kGreen;
  EXPECT_NEAR(static_cast<double>(detect_stripe(image.view(), {}, options).position[200]), 20, 0.2);
}

TEST(StripeDetector, RefusesOptionsOutOfRange) {
  const Image8 image(10, 10);
  for (const double bad : {0.0, 11.0, std::nan("")}) {
    StripeOptions options;
    options.sigma = bad;
    EXPECT_NE(error_of([&] { detect_stripe(image.view(), {}, options); }).find("sigma_px"),
              std::string::npos);
  }
  EXPECT_NE(error_of([] { detector_from_name("fur"); }).find("fir, centroid"), std::string::npos);
  EXPECT_NE(error_of([] { channel_from_name("rad"); }).find("red-excess"), std::string::npos);
}

TEST(StripeDetector, ThresholdCentroidOfOnePixelIsAsUnsureAsAPixelIsWide) {
  Image8 image(40, 60);
  for (int r = 0; r < image.rows; ++r) image.row(r)[30] = 200;
  StripeOptions options;
  options.detector = DetectorKind::kThresholdCentroid;
  options.sigma = 1;
  const StripeProfile profile = detect_stripe(image.view(), {}, options);
  ASSERT_EQ(profile.seen_count(), 40U);
  EXPECT_EQ(profile.position[20], 30);
  EXPECT_NEAR(profile.sigma[20], 1 / std::sqrt(12.0), 1e-6);
}

TEST(StripeDetector, ClippedSurfaceOnOneSideLeavesTheNoiseOfTheOther) {
  std::vector<std::int16_t> values(80, 255);
  std::vector<std::uint8_t> clipped(80, 1);
  for (std::size_t c = 0; c < 40; ++c) {
    values[c] = static_cast<std::int16_t>(c == 39 ? 120 : 30);
    clipped[c] = 0;
  }
  StripeCandidate found;
  found.position = 41;
  found.sigma_per_noise = 1;
  judge_clipped({values.data(), clipped.data(), 0, 80}, 2, 5, found);
  EXPECT_GT(found.sigma_per_noise, 0.6F);
  EXPECT_LE(found.sigma_per_noise, std::sqrt(0.5F));
}

TEST(StripeDetector, SurvivesTinyImages) {
  for (const int cols : {1, 2, 3, 5}) {
    const Image8 image(3, cols);
    EXPECT_EQ(detect_stripe(image.view(), {}, StripeOptions{}).seen_count(), 0U);
  }
}

}  // namespace
}  // namespace facula
