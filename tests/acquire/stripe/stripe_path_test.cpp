// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/stripe/stripe_path.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

using Rows = std::vector<std::vector<PathPlace>>;

/// What a path is worth by the definition in the header.
double worth_of(const Rows& rows, const std::vector<int>& path, const PathPrices& prices) {
  double worth = 0;
  int before = -1;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (path[r] < 0) continue;
    const PathPlace& place = rows[r][static_cast<std::size_t>(path[r])];
    worth += place.gain;
    if (before >= 0) {
      const auto from = static_cast<std::size_t>(before);
      const double n = static_cast<double>(r - from);
      const double d =
          (place.position - rows[from][static_cast<std::size_t>(path[from])].position) /
          prices.step;
      const double step = d * d / n + prices.gap_row * (n - 1);
      worth -= r - from > prices.reach ? prices.jump : std::min(prices.jump, step);
    }
    before = static_cast<int>(r);
  }
  return worth;
}

/// The best of all paths, by trying every one.
double best_by_trying(const Rows& rows, const PathPrices& prices) {
  std::vector<int> path(rows.size(), -1);
  double best = 0;
  for (;;) {
    best = std::max(best, worth_of(rows, path, prices));
    std::size_t r = 0;
    while (r < rows.size() && ++path[r] == static_cast<int>(rows[r].size())) path[r++] = -1;
    if (r == rows.size()) return best;
  }
}

TEST(StripePath, IsWorthAsMuchAsTheBestOfAllPaths) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed, 1);
    Rows rows(7);
    for (auto& row : rows) {
      const auto places = static_cast<std::size_t>(random.uniform() * 4);
      for (std::size_t k = 0; k < places; ++k) {
        row.push_back({random.uniform() * 30, random.uniform() * 2 - 0.3});
      }
    }
    const PathPrices prices = {.step = 3, .jump = 1.5, .gap_row = 0.1, .reach = 3};
    const std::vector<int> path = best_path(rows, prices);
    EXPECT_NEAR(worth_of(rows, path, prices), best_by_trying(rows, prices), 1e-9) << seed;
  }
}

TEST(StripePath, FollowsAFaintLinePastBrighterThings) {
  Rows rows(100);
  for (std::size_t r = 0; r < 100; ++r) {
    const double x = 40 + 0.3 * static_cast<double>(r);
    if (r >= 50 && r < 54) rows[r].push_back({200, 2});  // a lamp, twice as strong
    rows[r].push_back({x, 1});
  }
  const std::vector<int> path = best_path(rows);
  for (std::size_t r = 0; r < 100; ++r) {
    EXPECT_EQ(path[r], r >= 50 && r < 54 ? 1 : 0) << r;
  }
}

TEST(StripePath, TakesADepthStepThatLasts) {
  Rows rows(100);
  for (std::size_t r = 0; r < 100; ++r) rows[r].push_back({r < 50 ? 40.0 : 90.0, 1});
  const std::vector<int> path = best_path(rows);
  EXPECT_EQ(std::count(path.begin(), path.end(), 0), 100);
}

TEST(StripePath, BridgesRowsWithoutPlaces) {
  Rows rows(100);
  for (std::size_t r = 0; r < 100; ++r) {
    if (r >= 40 && r < 60) continue;
    rows[r].push_back({40, 1});
  }
  const std::vector<int> path = best_path(rows);
  EXPECT_EQ(std::count(path.begin(), path.end(), 0), 80);
}

TEST(StripePath, OfNothingIsNothing) {
  EXPECT_TRUE(best_path({}).empty());
  EXPECT_EQ(best_path(Rows(3)), (std::vector<int>{-1, -1, -1}));
  EXPECT_NE(error_of([] { best_path({}, {.step = 0}); }).find("path prices"), std::string::npos);
}

}  // namespace
}  // namespace facula
