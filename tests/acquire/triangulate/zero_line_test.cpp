// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/triangulate/zero_line.hpp>
#include <facula/tests/support/matchers.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr std::size_t kRows = 200;

/// The bed's line, bowed by the lens.
double bed_line(std::size_t r) {
  const double row = static_cast<double>(r);
  return 310 + 0.02 * row - 1e-4 * row * row;
}

/// How far an object in rows 80 to 139 moves the line.
double height(std::size_t r) {
  return r >= 80 && r < 140 ? 12.5 : 0;
}

StripeProfile bed() {
  StripeProfile profile = StripeProfile::none(kRows);
  for (std::size_t r = 0; r < kRows; ++r) {
    profile.seen[r] = 1;
    profile.position[r] = static_cast<float>(bed_line(r));
  }
  return profile;
}

StripeProfile object_shifted_by(double shift) {
  StripeProfile profile = bed();
  for (std::size_t r = 0; r < kRows; ++r) {
    profile.position[r] = static_cast<float>(bed_line(r) + height(r) + shift);
    profile.sigma[r] = 0.1F;
  }
  return profile;
}

ZeroLine zero_line() {
  ZeroLine result;
  result.bed_rows = {{0, 49}, {160, 199}};
  result.bed_position = 320;
  return result;
}

TEST(ZeroLine, TakesOutTheShiftAndTheBowOfTheLine) {
  StripeProfile profile = object_shifted_by(1.75);
  profile.seen[100] = 0;
  profile.position[100] = 0;
  EXPECT_NEAR(measure_against_bed(zero_line(), bed(), profile), 1.75, 1e-4);
  for (std::size_t r = 0; r < kRows; ++r) {
    const double expected = r == 100 ? 0 : 320 + height(r);
    EXPECT_NEAR(static_cast<double>(profile.position[r]), expected, 1e-4) << r;
    EXPECT_EQ(profile.sigma[r], 0.1F);
  }
}

/// A tenth of the bed's rows shows a spark instead: least squares alone would be off by pixels.
TEST(ZeroLine, IsNotMovedBySparksInTheReference) {
  StripeProfile reference = bed();
  for (std::size_t r = 5; r < kRows; r += 10) reference.position[r] += 40;
  for (std::size_t r = 0; r < kRows; r += 7) reference.seen[r] = 0;
  StripeProfile profile = object_shifted_by(-0.5);
  measure_against_bed(zero_line(), reference, profile);
  for (std::size_t r = 0; r < kRows; ++r) {
    EXPECT_NEAR(static_cast<double>(profile.position[r]), 320 + height(r), 0.1) << r;
  }
}

TEST(ZeroLine, IsNotMovedByAnObjectInAMinorityOfBedRows) {
  StripeProfile profile = object_shifted_by(2);
  for (std::size_t r = 0; r < 30; ++r) profile.position[r] += 9;
  EXPECT_NEAR(measure_against_bed(zero_line(), bed(), profile), 2, 1e-4);
}

TEST(ZeroLine, SaysWhatIsMissing) {
  StripeProfile profile = object_shifted_by(0);
  ZeroLine few = zero_line();
  few.bed_rows = {{0, 18}};
  EXPECT_NE(error_of([&] { measure_against_bed(few, bed(), profile); }).find("only 19 bed rows"),
            std::string::npos);
  StripeProfile reference = bed();
  for (std::size_t r = 19; r < kRows; ++r) reference.seen[r] = 0;
  EXPECT_NE(error_of([&] {
              measure_against_bed(zero_line(), reference, profile);
            }).find("seen in 19 rows of a zero_line frame"),
            std::string::npos);
  EXPECT_NE(error_of([&] {
              measure_against_bed(zero_line(), StripeProfile::none(10), profile);
            }).find("same size"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
