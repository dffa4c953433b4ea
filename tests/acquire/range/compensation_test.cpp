// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/range/compensation_fit.hpp>
#include <facula/tests/support/matchers.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace facula {
namespace {

using Plane = CompensationTable::Plane;

constexpr int kLines = 480;

/// A tilted, bowed line about `position`; nearer walls bow more.
double line_at(double position, int u) {
  const double y = (u - 239.5) / 240;
  return position + (1.3 * y + 0.8 * y * y) * (1 + 0.002 * (position - 300));
}

Plane bowed(double position) {
  Plane plane{position, {}};
  for (int u = 0; u < kLines; ++u) plane.measured.push_back(line_at(position, u));
  return plane;
}

std::vector<Plane> walls() {
  return {bowed(150), bowed(250), bowed(320), bowed(370), bowed(400), bowed(420)};
}

/// (2.5) to (2.8) written down term by term, with the sum of 1 / L below.
double literal(const std::vector<Plane>& planes, int s, int u, double z) {
  std::size_t i = 0;
  const auto line = static_cast<std::size_t>(u);
  while (i + 1 < planes.size() && planes[i + 1].measured[line] <= z) ++i;
  const bool below = z < planes[0].measured[line];
  const bool above = i + 1 == planes.size();
  std::vector<std::size_t> pair;
  if (below) pair = {0};
  if (above) pair = {planes.size() - 1};
  if (!below && !above) pair = {i, i + 1};
  double sum = 0;
  double weights = 0;
  for (const std::size_t plane : pair) {
    for (int m = u - s; m <= u + s; ++m) {
      if (m < 0 || m >= kLines) continue;
      const double measured = planes[plane].measured[static_cast<std::size_t>(m)];
      const double length = std::sqrt((z - measured) * (z - measured) + (u - m) * (u - m));
      sum += (planes[plane].position - measured) / length;
      weights += 1 / length;
    }
  }
  return sum / weights;
}

TEST(CompensationTable, IsTheLiteralFormulaTermByTerm) {
  const CompensationTable table(walls(), 7);
  Random random(1);
  for (int trial = 0; trial < 3000; ++trial) {
    const int u = static_cast<int>(random.below(kLines));
    const double z = 100 + 380 * random.uniform();
    ASSERT_NEAR(table.correction(u, z).shift, literal(table.planes(), 7, u, z), 1e-11)
        << u << " " << z;
  }
}

/// (2.7), and continuity there: the printed (2.8) blows up where this one arrives.
TEST(CompensationTable, GivesExactlyTheEntryAtATablePointAndTendsToItNearby) {
  const CompensationTable table(walls(), 7);
  for (const Plane& plane : table.planes()) {
    for (const int u : {0, 100, 240, 479}) {
      const double z = plane.measured[static_cast<std::size_t>(u)];
      EXPECT_EQ(table.correction(u, z).shift, plane.position - z);
      EXPECT_NEAR(table.correction(u, z + 1e-7).shift, plane.position - z, 1e-6);
      EXPECT_NEAR(table.correction(u, z - 1e-7).shift, plane.position - z, 1e-6);
    }
  }
}

TEST(CompensationTable, LeavesAStraightLineAlone) {
  std::vector<Plane> planes;
  for (const double position : {100.0, 200.0, 300.0}) {
    planes.push_back({position, std::vector<double>(kLines, position)});
  }
  const CompensationTable table(planes, 5);
  for (const double z : {50.0, 100.0, 133.3, 250.0, 400.0}) {
    EXPECT_NEAR(table.corrected(17, z), z, 1e-12);
  }
}

TEST(CompensationTable, AddsAConstantWhereEveryWallIsOffByIt) {
  std::vector<Plane> planes;
  for (const double position : {100.0, 200.0, 300.0}) {
    planes.push_back({position, std::vector<double>(kLines, position - 2.5)});
  }
  const CompensationTable table(planes, 5);
  for (const double z : {50.0, 100.0, 133.3, 250.0, 400.0}) {
    EXPECT_NEAR(table.corrected(470, z), z + 2.5, 1e-12);
  }
}

TEST(CompensationTable, TakesASmoothBowAwayBetweenTwoWalls) {
  const CompensationTable table(walls(), 5);
  for (const double position : {170.0, 200.0, 230.0, 290.0, 350.0, 390.0, 410.0}) {
    double worst = 0;
    double before = 0;
    for (int u = 0; u < kLines; ++u) {
      const double z = line_at(position, u);
      worst = std::max(worst, std::abs(table.corrected(u, z) - position));
      before = std::max(before, std::abs(z - position));
    }
    EXPECT_LT(worst, 0.07 * before) << position;
    EXPECT_LT(worst, 0.1) << position;
  }
}

TEST(CompensationTable, CountsLinesOutsideAsItsFirstAndLast) {
  const CompensationTable table(walls(), 5);
  EXPECT_EQ(table.correction(-3, 222).shift, table.correction(0, 222).shift);
  EXPECT_EQ(table.correction(900, 222).shift, table.correction(479, 222).shift);
}

TEST(CompensationTable, SlopeFollowsTheShift) {
  const CompensationTable table(walls(), 0);
  const double step = 20;
  const double by_difference =
      (table.correction(30, 200 + step).shift - table.correction(30, 200 - step).shift) /
      (2 * step);
  EXPECT_NEAR(table.correction(30, 200).slope, by_difference, 0.1 * std::abs(by_difference));
}

TEST(CompensationTable, RefusesEachBadTableInItsOwnWords) {
  const auto said = [](std::vector<Plane> planes, int window = 5) {
    return error_of([&] { const CompensationTable table(planes, window); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(said({}).find("at least one plane"), std::string::npos);
  EXPECT_NE(said({{100, {}}}).find("every line"), std::string::npos);
  EXPECT_NE(said({{100, {1, nan}}})
                .find("plane 0 of the compensation table, line 1: expected a "
                      "finite"),
            std::string::npos);
  EXPECT_NE(said({{nan, {1, 2}}}).find("finite position"), std::string::npos);
  EXPECT_NE(said({{100, {1, 2}}, {200, {3}}}).find("expected 2 lines as in plane 0, got 1"),
            std::string::npos);
  EXPECT_NE(said({{100, {100, 100}}, {200, {200, 90}}}).find("out of order in line 1"),
            std::string::npos);
  EXPECT_NE(said({{100, {100, 100}}}, -1).find("window"), std::string::npos);
}

std::vector<PlaneView> noisy_views(double noise) {
  Random random(2);
  std::vector<PlaneView> views;
  for (const double position : {420.0, 150.0, 250.0, 320.0, 370.0, 400.0}) {
    PlaneView view{std::to_string(static_cast<int>(position)), bowed(position).measured};
    for (double& z : view.positions) z += noise * random.normal();
    views.push_back(std::move(view));
  }
  return views;
}

TEST(FitCompensation, SortsTheWallsAndTakesTheNoiseOut) {
  const CompensationFit fit = fit_compensation(noisy_views(0.1));
  ASSERT_EQ(fit.planes.size(), 6U);
  EXPECT_EQ(fit.planes.front().name, "150");
  double squares = 0;
  for (int u = 0; u < kLines; ++u) {
    const double left =
        fit.table.planes()[2].measured[static_cast<std::size_t>(u)] - line_at(320, u);
    squares += left * left / kLines;
  }
  // A parabola over 41 lines keeps a share of 9 / (4 * 41) of the variance.
  EXPECT_NEAR(std::sqrt(squares), 0.1 * std::sqrt(9.0 / 164), 0.008);
  EXPECT_NEAR(fit.planes[2].scatter, 0.1, 0.01);
  EXPECT_NEAR(fit.planes[2].position, line_at(320, 240), 0.03);
  EXPECT_TRUE(std::isnan(fit.planes.front().held_out_rms));
  EXPECT_LT(fit.planes[2].held_out_rms, 0.15);
  EXPECT_GT(fit.planes[2].uncorrected_rms, 0.5);
  EXPECT_TRUE(fit.warnings.empty()) << fit.warnings.front();
}

TEST(FitCompensation, FillsLinesNotSeenAndSaysSo) {
  std::vector<PlaneView> views = noisy_views(0.02);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (int u = 0; u < 100; ++u) views[1].positions[static_cast<std::size_t>(u)] = nan;
  const CompensationFit fit = fit_compensation(views);
  EXPECT_EQ(fit.planes.front().filled, 100U);
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_NE(fit.warnings.front().find("100 of 480 lines were not seen"), std::string::npos);
}

TEST(FitCompensation, RefusesWallsItCannotUse) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto said = [](const std::vector<PlaneView>& views) {
    return error_of([&] { fit_compensation(views); });
  };
  EXPECT_NE(said({{"a", {1, 2}}}).find("at least two walls"), std::string::npos);
  std::vector<PlaneView> views = noisy_views(0);
  views[2].positions.resize(100);
  EXPECT_NE(said(views).find("expected 480 lines"), std::string::npos);
  views = noisy_views(0);
  for (int u = 40; u < 480; ++u) views[2].positions[static_cast<std::size_t>(u)] = nan;
  EXPECT_NE(said(views).find("a quarter is the least"), std::string::npos);
  views = noisy_views(0);
  for (int u = 200; u < 300; ++u) views[2].positions[static_cast<std::size_t>(u)] = nan;
  EXPECT_NE(said(views).find("middle of the picture"), std::string::npos);
  views = noisy_views(0);
  views.push_back(views.back());
  EXPECT_NE(said(views).find("out of order"), std::string::npos);
}

}  // namespace
}  // namespace facula
