// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/background_match.hpp>
#include <facula/acquire/stripe/bracket.hpp>
#include <facula/acquire/stripe/moving_pixels.hpp>
#include <facula/acquire/stripe/stripe_choice.hpp>
#include <facula/tests/acquire/stripe/line_image.hpp>
#include <facula/tests/acquire/stripe/lit_scene.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace facula {
namespace {

const Colour kWall = {30, 30, 30};
const Colour kLaser = {0, 0, 150};        // a red line, not clipped
const Colour kStrongLaser = {0, 0, 900};  // one whose core spills over to white
const Colour kWhite = {600, 600, 600};    // a lamp

double line_at(int r) {
  return 80 + 0.1 * r;
}

struct Finds {
  int right = 0;   ///< rows within 1 px of the line
  int wrong = 0;   ///< rows farther off
  double rms = 0;  ///< of the right ones [px]
};

Finds finds_of(const StripeProfile& profile, const std::function<double(int)>& line = line_at) {
  Finds finds;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0) continue;
    const double error = static_cast<double>(profile.position[r]) - line(static_cast<int>(r));
    (std::abs(error) < 1 ? finds.right : finds.wrong) += 1;
    if (std::abs(error) < 1) finds.rms += error * error;
  }
  finds.rms = std::sqrt(finds.rms / std::max(1, finds.right));
  return finds;
}

StripeOptions red_options() {
  StripeOptions options;
  options.channel = Channel::kRed;
  return options;
}

StripeOptions choosy_options() {
  StripeOptions options = red_options();
  options.max_candidates = 4;
  options.hue = LaserHue::kRed;
  return options;
}

TEST(Interference, LampTubeIsToldFromTheLineByTheColourAroundIt) {
  // Source A, case (b): the tube's core is as white as the line's, brighter and as long.
  LitScene scene(200, 240, kWall);
  scene.ridge(line_at, 2, kStrongLaser).ridge([](int) { return 180.0; }, 2, kWhite);
  const Image8 image = scene.picture(2, 1);
  const Finds plain = finds_of(detect_stripe(image.view(), {}, red_options()));
  const Finds choosy = finds_of(detect_stripe(image.view(), {}, choosy_options()));
  EXPECT_GT(plain.wrong, 30);
  EXPECT_EQ(choosy.wrong, 0);
  EXPECT_GE(choosy.right, 198);
  EXPECT_LT(choosy.rms, 0.1);
}

TEST(Interference, TheHueGateKeepsACoreClippedToWhite) {
  LitScene scene(200, 240, kWall);
  scene.ridge(line_at, 2, kStrongLaser);
  const Image8 image = scene.picture(2, 1);
  ASSERT_GE(static_cast<int>(image.row(100)[3 * 90]), 250);  // blue in the core: it is white
  const StripeProfile profile = detect_stripe(image.view(), {}, choosy_options());
  EXPECT_EQ(profile.seen_count(), 200U);
}

TEST(Interference, AWhiteHighlightOnARedThingIsNotTheLine) {
  // Source A, case (c).
  LitScene scene(200, 240, kWall);
  scene.paint(120, 0, 100, 200, {20, 20, 160});
  scene.ridge([](int) { return 170.0; }, 2, kWhite).ridge(line_at, 2, kLaser);
  const Image8 image = scene.picture(2, 1);
  const Finds choosy = finds_of(detect_stripe(image.view(), {}, choosy_options()));
  EXPECT_EQ(choosy.wrong, 0);
  EXPECT_GE(choosy.right, 198);
}

TEST(Interference, AThinRedThingPassesForTheLineWhereNoLineIs) {
  // What colour cannot tell; it is said in docs/stripe.md. A background frame takes it away.
  LitScene dark(200, 240, kWall);
  dark.ridge([](int) { return 170.0; }, 2, kLaser);
  EXPECT_GT(finds_of(detect_stripe(dark.picture(2, 1).view(), {}, choosy_options())).wrong, 150);
  LitScene lit = dark;
  lit.ridge(line_at, 2, kLaser);
  const Finds clean = finds_of(
      detect_stripe(lit.picture(2, 2).view(), dark.picture(2, 3).view(), choosy_options()));
  EXPECT_EQ(clean.wrong, 0);
  EXPECT_EQ(clean.right, 200);
}

TEST(Interference, AShortMirrorStripeLosesAgainstTheLineThatGoesOn) {
  LitScene scene(200, 240, kWall);
  scene.ridge(line_at, 2, {0, 0, 60});
  scene.ridge([](int r) { return 150 - 0.2 * r; }, 2, kLaser, 88, 100);
  const Image8 image = scene.picture(2, 1);
  const Finds plain = finds_of(detect_stripe(image.view(), {}, red_options()));
  const Finds choosy = finds_of(detect_stripe(image.view(), {}, choosy_options()));
  EXPECT_GE(plain.wrong, 4);
  EXPECT_EQ(choosy.wrong, 0);
  EXPECT_EQ(choosy.right, 200);
}

TEST(Interference, ALongMirrorStripeIsLeftToTheGate) {
  LitScene scene(200, 240, kWall);
  scene.ridge(line_at, 2, {0, 0, 60}).ridge([](int r) { return 200 - 0.1 * r; }, 2, kLaser);
  const Image8 image = scene.picture(2, 1);
  ColumnGate gate;
  gate.first.assign(200, 60);
  gate.end.assign(200, 130);
  const StripeView view = {image.view(), {}, &gate};
  const Finds gated = finds_of(detect_stripe(view, red_options()));
  EXPECT_EQ(gated.wrong, 0);
  EXPECT_EQ(gated.right, 200);
  EXPECT_EQ(finds_of(detect_stripe(image.view(), {}, red_options())).right, 0);
}

TEST(Interference, AGateOfAnotherSizeIsRefused) {
  const Image8 image = draw({});
  ColumnGate gate;
  gate.first.assign(3, 0);
  gate.end.assign(3, 10);
  EXPECT_NE(error_of([&] {
              detect_stripe(StripeView{image.view(), {}, &gate}, {});
            }).find("gate"),
            std::string::npos);
}

TEST(Interference, ChoosingDoesNotChangeACleanLine) {
  const Image8 image = draw({});
  StripeOptions options;
  const StripeProfile plain = detect_stripe(image.view(), {}, options);
  options.max_candidates = 4;
  const StripeProfile chosen = detect_stripe(image.view(), {}, options);
  EXPECT_EQ(plain.seen, chosen.seen);
  EXPECT_EQ(plain.position, chosen.position);
  EXPECT_EQ(plain.sigma, chosen.sigma);
}

/// A room whose right half is bright and dappled, as lamps leave it.
LitScene room() {
  LitScene scene(200, 240, {60, 60, 60});
  scene.paint(100, 0, 140, 200, {150, 150, 150});
  for (int i = 0; i < 12; ++i) {
    scene.ridge([i](int r) { return 20.0 * i + 0.3 * (r % 40); }, 4, {30, 30, 30});
  }
  return scene;
}

TEST(Flicker, GainAndOffsetOfTheWholeFrameAreFound) {
  LitScene lit = room();
  lit.dim([](int) { return 0.8; }).ridge(line_at, 2, kLaser);
  const Image8 frame = lit.picture(1.5, 1);
  const Image8 matched =
      match_background(frame.view(), room().picture(1.5, 2).view(), Flicker::kFrame);
  double off = 0;
  int count = 0;
  for (int r = 0; r < frame.rows; ++r) {
    for (int c = 150; c < frame.cols; ++c, ++count)
      off += frame.row(r)[3 * c] - matched.row(r)[3 * c];
  }
  EXPECT_NEAR(off / count, 0, 0.3);
}

TEST(Flicker, BandsOfARollingShutterAreTakenOffRowByRow) {
  LitScene lit = room();
  const auto band = [](int r) { return 1 + 0.15 * std::sin(2 * std::numbers::pi * r / 60.0); };
  lit.dim(band).ridge(line_at, 2, {0, 0, 40});
  const Image8 frame = lit.picture(1.5, 1);
  const Image8 dark = room().picture(1.5, 2);
  const auto finds = [&](Flicker flicker) {
    const Image8 matched = match_background(frame.view(), dark.view(), flicker);
    return finds_of(detect_stripe(frame.view(), matched.view(), red_options()));
  };
  EXPECT_EQ(finds(Flicker::kRows).wrong, 0);
  EXPECT_GE(finds(Flicker::kRows).right, 196);
  EXPECT_LT(finds(Flicker::kRows).rms, finds(Flicker::kIgnore).rms);
}

TEST(Flicker, ABackgroundThatFitsIsLeftAlone) {
  const Image8 dark = room().picture(1.5, 2);
  const Image8 matched =
      match_background(room().picture(1.5, 1).view(), dark.view(), Flicker::kRows);
  double off = 0;
  for (std::size_t i = 0; i < dark.pixels.size(); ++i) {
    off += std::abs(static_cast<double>(dark.pixels[i]) - matched.pixels[i]);
  }
  EXPECT_LT(off / static_cast<double>(dark.pixels.size()), 0.3);
  EXPECT_EQ(match_background(dark.view(), dark.view(), Flicker::kIgnore).pixels, dark.pixels);
}

TEST(Motion, WhatMovedBetweenTwoDarkFramesIsNotMeasured) {
  // A red thing walks through: at x = 140 before, 150 with the laser on, 160 after.
  const auto frame = [](double x, bool lit, std::uint64_t seed) {
    LitScene scene = room();
    scene.ridge([x](int) { return x; }, 3, {0, 0, 90}, 40, 120);
    if (lit) scene.ridge(line_at, 2, {0, 0, 60});
    return scene.picture(1.5, seed);
  };
  const Image8 before = frame(140, false, 1);
  const Image8 lit = frame(150, true, 2);
  const Image8 after = frame(160, false, 3);
  const Image8 dark = mean_of(before.view(), after.view());
  const Image8 moving = moving_pixels(before.view(), after.view());
  StripeOptions options = red_options();
  options.max_candidates = 3;
  const Finds trusting = finds_of(detect_stripe({lit.view(), dark.view()}, options));
  EXPECT_EQ(moving.row(10)[150], 0);
  EXPECT_EQ(moving.row(80)[140], 255);
  const Finds wary =
      finds_of(detect_stripe({lit.view(), dark.view(), nullptr, moving.view()}, options));
  EXPECT_LE(wary.wrong, trusting.wrong);
  EXPECT_EQ(wary.wrong, 0);
  EXPECT_GE(wary.right, 195);
}

TEST(Motion, RowsWhoseLineLiesOnMovingPixelsAreNotSeen) {
  const auto frame = [](double x, bool lit, std::uint64_t seed) {
    LitScene scene(200, 240, kWall);
    scene.ridge([x](int) { return x; }, 6, {90, 90, 90}, 40, 120);
    if (lit) scene.ridge(line_at, 2, kLaser);
    return scene.picture(1.5, seed);
  };
  const Image8 before = frame(80, false, 1);
  const Image8 lit = frame(86, true, 2);
  const Image8 after = frame(92, false, 3);
  const Image8 dark = mean_of(before.view(), after.view());
  const Image8 moving = moving_pixels(before.view(), after.view());
  const StripeProfile profile =
      detect_stripe({lit.view(), dark.view(), nullptr, moving.view()}, red_options());
  int inside = 0;
  int outside = 0;
  for (std::size_t r = 0; r < 200; ++r) (r >= 42 && r < 118 ? inside : outside) += profile.seen[r];
  EXPECT_LE(inside, 4);
  EXPECT_GE(outside, 118);
}

TEST(Motion, NoiseAndFlickerAloneAreNoMotion) {
  LitScene brighter = room();
  brighter.dim([](int) { return 1.02; });
  const Image8 moving = moving_pixels(room().picture(2, 1).view(), brighter.picture(2, 2).view());
  std::size_t moved = 0;
  for (const std::uint8_t m : moving.pixels) moved += m != 0 ? 1 : 0;
  EXPECT_LT(moved, moving.pixels.size() / 5000);
}

ExposedProfile exposed(double exposure, std::uint64_t seed, double noise = 2) {
  LineImage line;
  line.rows = 2000;
  line.cols = 80;
  line.amplitude = 60 * exposure;
  line.noise = noise;
  line.position = [](int r) { return 40 + 0.003 * r; };
  line.seed = seed;
  return {detect_stripe(draw(line).view(), {}, {}), exposure};
}

double chi2_of(const StripeProfile& profile) {
  double sum = 0;
  int count = 0;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0) continue;
    const double error =
        static_cast<double>(profile.position[r]) - (40 + 0.003 * static_cast<double>(r));
    sum += std::pow(error / static_cast<double>(profile.sigma[r]), 2);
    ++count;
  }
  return sum / count;
}

TEST(Bracket, TakesTheStrongestExposureThatIsNotClipped) {
  const ExposedProfile dim = exposed(0.5, 1);
  const ExposedProfile good = exposed(2, 2);
  const ExposedProfile clipped = exposed(8, 3);
  ASSERT_EQ(clipped.profile.saturated[1000], 1);
  const StripeProfile merged = merge_bracket({dim, good, clipped});
  EXPECT_EQ(merged.position, good.profile.position);
  EXPECT_EQ(merged.sigma, good.profile.sigma);
  EXPECT_NEAR(static_cast<double>(merged.amplitude[1000]), 30, 3);  // as the first exposure sees it
  EXPECT_NEAR(chi2_of(merged), 1, 0.15);
}

TEST(Bracket, FillsRowsFromWhicheverExposureSeesThem) {
  ExposedProfile dim = exposed(0.5, 1);
  ExposedProfile bright = exposed(8, 2);
  std::fill_n(dim.profile.seen.begin(), 1000, std::uint8_t{0});
  std::fill_n(bright.profile.seen.begin() + 1500, 500, std::uint8_t{0});
  const StripeProfile merged = merge_bracket({dim, bright});
  EXPECT_EQ(merged.seen_count(), 2000U);
  EXPECT_EQ(merged.position[500], bright.profile.position[500]);
  EXPECT_EQ(merged.saturated[500], 1);  // clipped, but all there is
  EXPECT_EQ(merged.position[1200], dim.profile.position[1200]);
}

TEST(Bracket, TheMeanOfIndependentExposuresHasAnHonestSigma) {
  const std::vector<ExposedProfile> bracket = {exposed(1.5, 1), exposed(2, 2), exposed(2.5, 3)};
  const StripeProfile merged = merge_bracket(bracket, {.combine = true});
  EXPECT_LT(merged.sigma[1000], 0.75F * bracket[2].profile.sigma[1000]);
  EXPECT_NEAR(chi2_of(merged), 1, 0.15);
}

TEST(Bracket, ExposuresThatDisagreeAreNotAveraged) {
  ExposedProfile first = exposed(2, 1);
  ExposedProfile second = exposed(2, 2);
  for (float& p : second.profile.position) p += 5;
  const StripeProfile merged = merge_bracket({first, second}, {.combine = true});
  for (std::size_t r = 0; r < merged.size(); r += 100) {
    const float p = merged.position[r];
    EXPECT_TRUE(p == first.profile.position[r] || p == second.profile.position[r]) << r;
  }
}

TEST(Bracket, BadBracketsAreRefused) {
  EXPECT_NE(error_of([] { merge_bracket({}); }).find("none"), std::string::npos);
  EXPECT_NE(error_of([] {
              merge_bracket({{StripeProfile::none(3), 0}});
            }).find("above 0"),
            std::string::npos);
  EXPECT_NE(error_of([] {
              merge_bracket({{StripeProfile::none(3), 1}, {StripeProfile::none(4), 1}});
            }).find("same number of rows"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
