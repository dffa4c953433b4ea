// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/tests/acquire/stripe/cramer_rao.hpp>
#include <facula/tests/acquire/stripe/position_errors.hpp>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr int kRows = 4000;

LineImage line_of(double sigma, double amplitude, double noise) {
  LineImage line;
  line.rows = kRows;
  line.cols = 160;
  line.sigma = sigma;
  line.amplitude = amplitude;
  line.noise = noise;
  line.position = [](int r) { return 77 + 0.00137 * r; };
  return line;
}

PositionErrors errors_of(const LineImage& line, const std::function<bool(int)>& counts = {}) {
  StripeOptions options;
  options.sigma = line.sigma;
  PositionErrors errors;
  add_errors(line, detect_stripe(draw(line).view(), {}, options), counts, errors);
  return errors;
}

/// Without pixels' integration, clipping and rounding: n sqrt(2 s / (A^2 sqrt(pi))).
TEST(StripePrecision, BoundAgreesWithItsClosedForm) {
  for (const double sigma : {2.0, 4.0}) {
    LineImage line = line_of(sigma, 60, 2);
    line.background = 60;
    const double noise = std::sqrt(4 + 1.0 / 12);
    const double closed = noise * std::sqrt(2 * sigma / std::sqrt(std::numbers::pi)) / 60;
    const LineBound bound = line_bound(line);
    EXPECT_NEAR(bound.known_shape / closed, 1, 0.05 / sigma);
    EXPECT_GE(bound.unknown, bound.known_shape);
    EXPECT_LT(bound.unknown, 1.01 * bound.known_shape);
  }
  LineImage clipped = line_of(2, 800, 2);
  EXPECT_GT(line_bound(clipped).unknown, 2 * line_bound(line_of(2, 800, 2 * 200 / 800.0)).unknown);
}

TEST(StripePrecision, DefaultStaysWithinTenPerCentOfTheBound) {
  for (const double sigma : {2.0, 4.0}) {
    for (const double noise : {2.0, 4.0}) {
      for (const double amplitude : {60.0, 200.0}) {
        const LineImage line = line_of(sigma, amplitude, noise);
        const PositionErrors e = errors_of(line);
        EXPECT_EQ(e.seen, kRows);
        EXPECT_LT(e.rms(), 1.10 * line_bound(line).unknown)
            << "sigma " << sigma << " noise " << noise << " amplitude " << amplitude;
      }
    }
  }
}

TEST(StripePrecision, DefaultStatesAnHonestSigma) {
  for (const double sigma : {1.0, 2.0, 4.0}) {
    for (const double noise : {1.0, 4.0}) {
      for (const double amplitude : {60.0, 200.0}) {
        const PositionErrors e = errors_of(line_of(sigma, amplitude, noise));
        EXPECT_GT(e.chi2(), 0.8) << sigma << " noise " << noise << " amplitude " << amplitude;
        EXPECT_LT(e.chi2(), 1.2) << sigma << " noise " << noise << " amplitude " << amplitude;
      }
    }
  }
}

TEST(StripePrecision, DefaultStatesAnHonestSigmaUnderPhotonNoise) {
  for (const double sigma : {1.0, 2.0, 4.0}) {
    LineImage line = line_of(sigma, 200, 1);
    line.photons = 0.1;
    const PositionErrors e = errors_of(line);
    EXPECT_GT(e.chi2(), 0.8) << sigma;
    EXPECT_LT(e.chi2(), 1.2) << sigma;
  }
}

TEST(StripePrecision, DefaultIsNotThrownByAClippedCore) {
  for (const double sigma : {1.0, 2.0, 4.0}) {
    for (const double noise : {1.0, 4.0}) {
      const PositionErrors e = errors_of(line_of(sigma, 800, noise));
      EXPECT_EQ(e.seen, kRows);
      EXPECT_LT(e.rms(), 0.05) << sigma;
      EXPECT_LT(std::abs(e.bias()), 0.005) << sigma;
    }
  }
}

/// Steps of 12 px to and fro every 40 rows; the rows within 8 of a step.
TEST(StripePrecision, DefaultKeepsDepthStepsSharp) {
  LineImage line = line_of(2, 200, 4);
  line.second_offset = 12;
  line.second_share = [](int r) { return (r / 40) % 2 == 1 ? 1.0 : 0.0; };
  const PositionErrors e =
      errors_of(line, [](int r) { return r >= 8 && (r % 40 < 8 || r % 40 >= 32); });
  EXPECT_EQ(e.seen, e.rows);
  EXPECT_LT(e.worst, 0.15);
  EXPECT_LT(e.rms(), 1.1 * line_bound(line_of(2, 200, 4)).unknown);
}

}  // namespace
}  // namespace facula
