// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>

#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// Splitmix64, written from its description: a counter with the golden gamma and a mixer.
std::uint64_t reference_splitmix(std::uint64_t& counter) {
  counter += 11400714819323198485ULL;
  std::uint64_t z = counter;
  z ^= z >> 30;
  z *= 13787848793156543929ULL;
  z ^= z >> 27;
  z *= 10723151780598845931ULL;
  return z ^ z >> 31;
}

/// Xoshiro256++, one step, written from the paper's table (rotations 23 and 45, shift 17).
std::uint64_t reference_xoshiro(std::array<std::uint64_t, 4>& s) {
  const auto turned = [](std::uint64_t x, int k) { return x << k | x >> (64 - k); };
  const std::uint64_t result = turned(s[0] + s[3], 23) + s[0];
  const std::array<std::uint64_t, 4> old = s;
  s[0] = old[0] ^ old[3] ^ old[1];
  s[1] = old[1] ^ old[2] ^ old[0];
  s[2] = old[2] ^ old[0] ^ old[1] << 17;
  s[3] = turned(old[3] ^ old[1], 45);
  return result;
}

TEST(Random, ReferencesGiveThePublishedNumbers) {
  std::uint64_t counter = 1234567;
  EXPECT_EQ(reference_splitmix(counter), 6457827717110365317ULL);
  EXPECT_EQ(reference_splitmix(counter), 3203168211198807973ULL);
  std::array<std::uint64_t, 4> state{1, 2, 3, 4};
  for (const std::uint64_t expected : {41943041ULL,
                                       58720359ULL,
                                       3588806011781223ULL,
                                       3591011842654386ULL,
                                       9228616714210784205ULL,
                                       9973669472204895162ULL}) {
    EXPECT_EQ(reference_xoshiro(state), expected);
  }
}

TEST(Random, IsXoshiroSeededBySplitmix) {
  std::uint64_t counter = 42;
  counter = reference_splitmix(counter) ^ 1U;
  std::array<std::uint64_t, 4> state{};
  for (auto& word : state) word = reference_splitmix(counter);
  Random random(42);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(random.bits(), reference_xoshiro(state));
}

TEST(Random, NormalHasTheMomentsOfTheNormalDistribution) {
  Random random(7);
  constexpr int kCount = 400000;
  double m1 = 0;
  double m2 = 0;
  double m3 = 0;
  double m4 = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    m1 += x / kCount;
    m2 += x * x / kCount;
    m3 += x * x * x / kCount;
    m4 += x * x * x * x / kCount;
  }
  // Five standard errors: 1, sqrt(2), sqrt(15) and sqrt(96) over the root of the count.
  const double five = 5 / std::sqrt(kCount);
  EXPECT_NEAR(m1, 0, five);
  EXPECT_NEAR(m2, 1, five * std::sqrt(2));
  EXPECT_NEAR(m3, 0, five * std::sqrt(15));
  EXPECT_NEAR(m4, 3, five * std::sqrt(96));
}

TEST(Random, UniformFillsTheUnitIntervalEvenly) {
  Random random(8);
  std::array<int, 20> bins{};
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    ++bins[static_cast<std::size_t>(x * 20)];
  }
  double chi2 = 0;
  for (const int n : bins) chi2 += (n - kCount / 20.0) * (n - kCount / 20.0) / (kCount / 20.0);
  EXPECT_LT(chi2, 50.8);  // chi-squared, 19 degrees of freedom, p = 1e-4
}

TEST(Random, BelowReachesEveryNumberEvenly) {
  Random random(9);
  std::array<int, 6> counts{};
  for (int i = 0; i < 60000; ++i) ++counts.at(random.below(6));
  for (const int n : counts) EXPECT_NEAR(n, 10000, 5 * std::sqrt(60000 * 5.0 / 36));
  EXPECT_EQ(random.below(1), 0U);
}

TEST(Random, RepeatsWithItsSeedAndDiffersWithItsStream) {
  Random a(3, 1);
  Random same(3, 1);
  Random other_stream(3, 2);
  Random other_seed(4, 1);
  double correlation = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const std::uint64_t bits = a.bits();
    ASSERT_EQ(bits, same.bits());
    EXPECT_NE(bits, other_seed.bits());
    const std::uint64_t other = other_stream.bits();
    EXPECT_NE(bits, other);
    correlation += (static_cast<double>(bits) * 0x1p-64 - 0.5) *
                   (static_cast<double>(other) * 0x1p-64 - 0.5) * 12 / kCount;
  }
  EXPECT_NEAR(correlation, 0, 5 / std::sqrt(kCount));
}

}  // namespace
}  // namespace facula
