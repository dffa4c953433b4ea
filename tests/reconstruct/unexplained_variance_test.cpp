// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/unexplained_variance.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(UnexplainedVariance, IsTheClosedFormOfEqualVariances) {
  // sum r^2 / (s^2 + t^2) = f has t^2 = sum r^2 / f - s^2.
  EXPECT_NEAR(unexplained_variance({4, 9, 16}, {1, 1, 1}, 2), 29.0 / 2 - 1, 1e-10);
}

TEST(UnexplainedVariance, IsTheRootOfAQuadraticForTwoVariances) {
  // 8 / (1 + t) + 12 / (3 + t) = 4: t^2 - t - 6 = 0, whose root above 0 is 3.
  EXPECT_NEAR(unexplained_variance({8, 12}, {1, 3}, 4), 3, 1e-10);
}

TEST(UnexplainedVariance, MakesTheSumTheDegreesOfFreedomHoweverUnequalTheSigmas) {
  Random random(1);
  std::vector<double> squares;
  std::vector<double> variances;
  for (int i = 0; i < 1000; ++i) {
    variances.push_back(std::pow(10, -12 * random.uniform()));
    squares.push_back(std::pow(random.normal(), 2));
  }
  const double added = unexplained_variance(squares, variances, 997);
  double sum = 0;
  for (std::size_t i = 0; i < squares.size(); ++i) sum += squares[i] / (variances[i] + added);
  EXPECT_NEAR(sum, 997, 1e-6);
}

TEST(UnexplainedVariance, IsNothingWhereSigmasExplainAllOrNothingIsFree) {
  EXPECT_EQ(unexplained_variance({0.5, 0.4, 0.1}, {1, 1, 1}, 1), 0);
  EXPECT_EQ(unexplained_variance({4, 9, 16}, {1, 1, 1}, 0), 0);
  EXPECT_EQ(unexplained_variance({}, {}, 5), 0);
}

}  // namespace
}  // namespace facula
