// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/acquire/stripe/stripe_location.hpp>
#include <facula/acquire/stripe/stripe_simd.hpp>
#include <facula/tests/acquire/stripe/line_image.hpp>

#include <array>

#include <gtest/gtest.h>
#include <hwy/highway.h>

namespace facula {
namespace {

/// Lets only `targets` be used (0: all again), for as long as it lives.
class Targets {
 public:
  explicit Targets(std::int64_t targets) { use(targets); }
  ~Targets() { use(0); }
  Targets(const Targets&) = delete;
  Targets& operator=(const Targets&) = delete;

 private:
  static void use(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().DeInit();
  }
};

void expect_same(const StripeProfile& a, const StripeProfile& b) {
  EXPECT_EQ(a.noise, b.noise);
  EXPECT_EQ(a.seen, b.seen);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.sigma, b.sigma);
  EXPECT_EQ(a.amplitude, b.amplitude);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.saturated, b.saturated);
}

/// The plain functions against every instruction set of this machine, bit for bit.
void expect_same_everywhere(ImageView8 frame, ImageView8 dark, const StripeOptions& options) {
  StripeProfile plain;
  {
    const Targets none(HWY_SCALAR);
    ASSERT_FALSE(measure_frame_simd({frame, dark}, options, nullptr).has_value());
    plain = detect_stripe(frame, dark, options);
  }
  ASSERT_GT(hwy::SupportedAndGeneratedTargets().size(), 1U);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    const Targets only(target);
    EXPECT_EQ(measure_frame_simd({frame, dark}, options, nullptr).has_value(),
              target != HWY_SCALAR);
    expect_same(plain, detect_stripe(frame, dark, options));
  }
}

Image8 in_colour(const Image8& grey) {
  Image8 colour(grey.rows, grey.cols, 3);
  for (std::size_t i = 0; i < grey.pixels.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      colour.pixels[3 * i + k] = static_cast<std::uint8_t>(grey.pixels[i] / (3 - k));
    }
  }
  return colour;
}

/// Sizes that fill no vector, lines of all widths, slopes and heights, at borders and off them.
LineImage line_number(int i) {
  LineImage line;
  line.rows = 1 + i * 7 % 90;
  line.cols = 64 + i * 37 % 700;
  line.sigma = 0.6 + (i % 7) * 0.55;
  line.noise = i % 5;
  line.amplitude = i % 3 == 0 ? 800 : 30 + 3 * i;
  const double start = i % 4 == 0 ? 2 : 0.5 * line.cols;
  const double slope = 0.7 * (i % 6) * (i % 2 == 0 ? -1 : 1);
  line.position = [=](int r) { return start + slope * r; };
  line.seed = static_cast<std::uint64_t>(i);
  return line;
}

TEST(StripeSimd, GivesThePlainNumbersOnLinesOfAllKinds) {
  for (int i = 0; i < 48; ++i) {
    SCOPED_TRACE(i);
    const LineImage line = line_number(i);
    StripeOptions options{.sigma = std::min(4.0, line.sigma)};
    if (i % 9 == 0) options.region = {5, 3, line.cols / 2, line.rows / 2};
    if (i % 10 == 0) options.direction = StripeDirection::kPerColumn;
    expect_same_everywhere(draw(line).view(), {}, options);
  }
}

TEST(StripeSimd, GivesThePlainNumbersWithABackgroundAndInEveryChannel) {
  for (int i = 0; i < 16; ++i) {
    SCOPED_TRACE(i);
    LineImage line = line_number(i);
    const Image8 lit = draw(line);
    line.amplitude = 3;
    line.seed += 1000;
    const Image8 dark = draw(line);
    StripeOptions options{.channel = static_cast<Channel>(i % 8),
                          .sigma = std::min(4.0, line.sigma)};
    expect_same_everywhere(lit.view(), dark.view(), options);
    const Image8 colour = in_colour(lit);
    expect_same_everywhere(colour.view(), {}, options);
    expect_same_everywhere(colour.view(), in_colour(dark).view(), options);
  }
}

TEST(StripeSimd, GivesThePlainNumbersOnNoise) {
  Random random(7, 1);
  for (const int cols : {64, 65, 127, 640}) {
    Image8 image(70, cols);
    for (auto& p : image.pixels) p = static_cast<std::uint8_t>(random.uniform() * 256);
    expect_same_everywhere(image.view(), {}, {.min_snr = 1, .min_run = 1});
  }
  const Image8 black(40, 200);
  expect_same_everywhere(black.view(), {}, {});
}

TEST(StripeSimd, LocatesAndMeasuresASignalAsAFrame) {
  const LineImage line;
  const Image8 image = draw(line);
  const StripeSignal signal(image.view(), {}, Channel::kGrey, false);
  const StripeOptions options;
  const StripeProfile parts = measure_stripe(signal, locate_stripe(signal, options), options);
  expect_same(detect_stripe(image.view(), {}, options), parts);
  EXPECT_EQ(parts.seen_count(), 400U);
}

}  // namespace
}  // namespace facula
