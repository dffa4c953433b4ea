// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/stripe/stripe_median.hpp>
#include <facula/tests/acquire/stripe/position_errors.hpp>
#include <facula/tests/support/matchers.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

StripeProfile profile_of(const std::vector<float>& positions) {
  StripeProfile profile = StripeProfile::none(positions.size());
  profile.position = positions;
  profile.seen.assign(positions.size(), 1);
  profile.sigma.assign(positions.size(), 0.1F);
  return profile;
}

TEST(StripeMedian, TakesTheMiddleOfThreeSeenRows) {
  StripeProfile profile = profile_of({5, 9, 6, 7, 1});
  median_along(profile, false);
  EXPECT_EQ(profile.position, (std::vector<float>{5, 6, 7, 6, 1}));
}

TEST(StripeMedian, LeavesRowsBesideUnseenOnesAlone) {
  StripeProfile profile = profile_of({5, 9, 6, 7, 1});
  profile.seen[2] = 0;
  const StripeProfile before = profile;
  median_along(profile, false);
  EXPECT_EQ(profile.position, before.position);
  EXPECT_EQ(profile.sigma, before.sigma);
}

TEST(StripeMedian, SurvivesShortProfiles) {
  for (std::size_t rows = 0; rows < 4; ++rows) {
    StripeProfile profile = profile_of(std::vector<float>(rows, 1));
    median_along(profile, false);
    EXPECT_EQ(profile.size(), rows);
  }
}

TEST(StripeMedian, KeepsTheSigmaOfRowsThatShareLight) {
  StripeProfile profile = profile_of({5, 9, 6});
  median_along(profile, true);
  EXPECT_EQ(profile.position[1], 6);
  EXPECT_EQ(profile.sigma[1], 0.1F);
}

/// Reduced chi2 of normal errors about a line, for leans from none to far more than sigma.
TEST(StripeMedian, StatesTheSigmaOfAMedianOfThree) {
  for (const double lean : {0.0, 0.05, 0.1, 0.2, 1.0}) {
    Random random(7);
    std::vector<float> positions;
    for (int r = 0; r < 20000; ++r) {
      positions.push_back(static_cast<float>(lean * r + 0.1 * random.normal()));
    }
    StripeProfile profile = profile_of(positions);
    median_along(profile, false);
    double chi2 = 0;
    double square = 0;
    for (int r = 1; r + 1 < 20000; ++r) {
      const auto i = static_cast<std::size_t>(r);
      const double error = static_cast<double>(profile.position[i]) - lean * r;
      chi2 += std::pow(error / static_cast<double>(profile.sigma[i]), 2) / 19998;
      square += error * error / 19998;
    }
    EXPECT_NEAR(chi2, 1, 0.09) << lean;
    if (lean == 0) {
      EXPECT_NEAR(square, 0.4487 * 0.01, 0.0002);
    }
  }
}

TEST(StripeMedian, IsTakenWhenTheOptionsAskForIt) {
  LineImage line;
  line.position = [](int) { return 60.3; };
  const Image8 image = draw(line);
  StripeOptions options;
  PositionErrors alone;
  add_errors(line, detect_stripe(image.view(), {}, options), {}, alone);
  options.median_rows = 3;
  PositionErrors of_three;
  add_errors(line, detect_stripe(image.view(), {}, options), {}, of_three);
  EXPECT_NEAR(of_three.rms() / alone.rms(), std::sqrt(0.4487), 0.1);
  options.median_rows = 2;
  EXPECT_NE(error_of([&] { detect_stripe(image.view(), {}, options); }).find("median_rows"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
