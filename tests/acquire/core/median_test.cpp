// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/random.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(Median, IsTheMiddleOfTheSortedValues) {
  Random random(5);
  for (std::size_t count = 1; count < 40; ++count) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(random.normal());
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(median(values), sorted[count / 2]) << count;
  }
}

TEST(Median, OfNothingIsZero) {
  std::vector<float> none;
  EXPECT_EQ(median(none), 0);
}

}  // namespace
}  // namespace facula
