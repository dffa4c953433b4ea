// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/csv_table.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/range/range_fit.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace facula {
namespace {

const std::vector<double> kDistances = {0.2, 0.3, 0.45, 0.6, 0.8, 1.0, 1.4, 2.0, 2.8, 4.0};

std::vector<RangePoint> points_on(const RangeModel& model, double origin = 0) {
  std::vector<RangePoint> points;
  for (const double d : kDistances) points.push_back({model.position(d), d + origin});
  return points;
}

struct PaperTable {
  std::vector<RangePoint> points;
  double paper_rms = 0;  ///< [m]
};

PaperTable paper_table(const std::string& name) {
  const CsvTable csv = CsvTable::from_file(shipped_data("tables/" + name));
  const auto px = csv.column({"pixel_px"});
  const auto truth = csv.column({"true_mm"});
  const auto fit = csv.column({"paper_fit_mm"});
  PaperTable table;
  for (std::size_t i = 0; i < px.size(); ++i) {
    table.points.push_back({px[i], truth[i]});
    table.paper_rms += (fit[i] - truth[i]) * (fit[i] - truth[i]);
  }
  table.paper_rms = std::sqrt(table.paper_rms / static_cast<double>(px.size()));
  return table;
}

TEST(RangeModel, GivesBackThePositionOfADepthWithBendAndEitherSign) {
  for (const double slope : {75.0, -75.0}) {
    for (const double bend : {0.0, 4e-7, -4e-7}) {
      const RangeModel model{.slope = slope, .vanishing = 490, .bend = bend, .centre = 320};
      for (const double d : kDistances) {
        EXPECT_NEAR(model.depth(model.position(d)).value_or(-1), d, 1e-9 * d) << slope << " " << d;
      }
      const double px = model.position(1.0);
      const double slope_by_difference =
          (model.depth(px + 1e-4).value_or(0) - model.depth(px - 1e-4).value_or(0)) / 2e-4;
      EXPECT_NEAR(model.depth_per_px(px) / slope_by_difference, 1, 1e-6);
    }
  }
}

TEST(RangeModel, HasNoDepthBeyondTheVanishingPosition) {
  const RangeModel model{.slope = 75, .vanishing = 490};
  EXPECT_FALSE(model.depth(490).has_value());
  EXPECT_FALSE(model.depth(500).has_value());
  EXPECT_FALSE(model.depth(std::nan("")).has_value());
  EXPECT_EQ(model.position(HUGE_VAL), 490);
}

TEST(FitRange, RecoversTheHyperbolaItWasMadeFrom) {
  for (const RangeResidual minimise : {RangeResidual::kPixels, RangeResidual::kDistances}) {
    const RangeModel truth{.slope = -137.3, .vanishing = 100};
    const RangeFit fit = fit_range(points_on(truth), {.minimise = minimise});
    EXPECT_NEAR(fit.model.slope, truth.slope, 1e-7);
    EXPECT_NEAR(fit.model.vanishing, truth.vanishing, 1e-7);
    EXPECT_LT(fit.rms, 1e-9);
    EXPECT_LT(fit.held_out_rms_px, 1e-6);
  }
}

TEST(FitRange, RecoversBendAndOrigin) {
  for (const RangeResidual minimise : {RangeResidual::kPixels, RangeResidual::kDistances}) {
    const RangeModel bent{.slope = 75.1, .vanishing = 490, .bend = 3e-7, .centre = 320};
    const RangeFit fit =
        fit_range(points_on(bent), {.terms = RangeTerms::kBend, .minimise = minimise});
    EXPECT_NEAR(fit.model.bend, 3e-7, 1e-12);
    EXPECT_NEAR(fit.model.slope, 75.1, 1e-5);
    const RangeModel plain{.slope = 75.1, .vanishing = 490};
    const RangeFit moved =
        fit_range(points_on(plain, -0.025), {.terms = RangeTerms::kOrigin, .minimise = minimise});
    EXPECT_NEAR(moved.origin, -0.025, 1e-8);
    EXPECT_NEAR(moved.model.slope, 75.1, 1e-5);
  }
}

/// Source B, tables 3.1 and 3.2: fit against the paper's fit. The paper's smaller residual of the
/// second is its own and not a hyperbola's.
TEST(FitRange, MeetsTheSlopesOfThePapersTablesAndNotItsResiduals) {
  const RangeFitOptions in_distances{.minimise = RangeResidual::kDistances};
  const PaperTable green = paper_table("curve_fit_fs760.csv");
  const RangeFit green_fit = fit_range(green.points, in_distances);
  EXPECT_NEAR(1000 * green_fit.model.slope, 75100, 100);
  EXPECT_NEAR(1000 * green_fit.rms, 12.8, 0.05);
  EXPECT_NEAR(1000 * green.paper_rms, 11.7, 0.05);
  const PaperTable red = paper_table("curve_fit_fs1500.csv");
  const RangeFit red_fit = fit_range(red.points, in_distances);
  EXPECT_NEAR(1000 * red_fit.model.slope, 137300, 50);
  EXPECT_NEAR(1000 * red_fit.rms, 13.7, 0.05);
  EXPECT_NEAR(1000 * red.paper_rms, 5.2, 0.05);
  // Nothing near f s / p for the 6 um that the paper states.
  EXPECT_GT(std::abs(1000 * red_fit.model.slope - 1500 / 0.006), 100000);
}

/// No hyperbola with any slope and vanishing position comes near the paper's 5.2 mm: a search that
/// knows nothing of the fit's method.
TEST(FitRange, LeavesNoBetterHyperbolaToBeFound) {
  const PaperTable red = paper_table("curve_fit_fs1500.csv");
  const RangeFit fit = fit_range(red.points, {.minimise = RangeResidual::kDistances});
  double best = HUGE_VAL;
  for (double slope = 134; slope < 141; slope += 0.02) {
    for (double vanishing = 479; vanishing < 483; vanishing += 0.01) {
      double sum = 0;
      for (const RangePoint& p : red.points) {
        const double d = slope / (vanishing - p.px) - p.distance;
        sum += d * d;
      }
      best = std::min(best, std::sqrt(sum / static_cast<double>(red.points.size())));
    }
  }
  EXPECT_LE(fit.rms, best);
  EXPECT_NEAR(1000 * best, 1000 * fit.rms, 0.05);
}

/// For the plain model over the pixels, which is linear, the error of a point left out is its
/// residual over one minus its leverage.
TEST(FitRange, LeavesOutOneAsTheHatMatrixSays) {
  const PaperTable red = paper_table("curve_fit_fs1500.csv");
  const RangeFit fit = fit_range(red.points);
  const auto rows = static_cast<Eigen::Index>(red.points.size());
  Eigen::MatrixXd design(rows, 2);
  Eigen::VectorXd px(rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const RangePoint& p = red.points[static_cast<std::size_t>(i)];
    design.row(i) << -1 / p.distance, 1;
    px[i] = p.px;
  }
  const Eigen::MatrixXd hat = design * (design.transpose() * design).inverse() * design.transpose();
  const Eigen::VectorXd residual = px - hat * px;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto index = static_cast<std::size_t>(i);
    EXPECT_NEAR(fit.residual_px[index], residual[i], 1e-8);
    EXPECT_NEAR(fit.held_out_px[index], residual[i] / (1 - hat(i, i)), 1e-7);
  }
}

TEST(FitRange, KnowsItsOwnUncertainty) {
  const RangeModel truth{.slope = 75.1, .vanishing = 490};
  constexpr int kTrials = 600;
  double slope_squares = 0;
  double vanishing_squares = 0;
  double said_slope = 0;
  double said_vanishing = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Random random(7, static_cast<std::uint64_t>(trial));
    std::vector<RangePoint> points = points_on(truth);
    for (RangePoint& p : points) p.px += 0.1 * random.normal();
    const RangeFit fit = fit_range(points);
    slope_squares += std::pow(fit.model.slope - truth.slope, 2);
    vanishing_squares += std::pow(fit.model.vanishing - truth.vanishing, 2);
    said_slope += fit.sigma[0] * fit.sigma[0];
    said_vanishing += fit.sigma[1] * fit.sigma[1];
  }
  // 600 trials know a variance to 6 %.
  EXPECT_NEAR(said_slope / slope_squares, 1, 0.2);
  EXPECT_NEAR(said_vanishing / vanishing_squares, 1, 0.2);
}

TEST(FitRange, WarnsOfABendThatTheDistancesCannotShow) {
  Random random(3);
  const RangeModel truth{.slope = 75.1, .vanishing = 490};
  std::vector<RangePoint> points = points_on(truth);
  for (RangePoint& p : points) p.px += 0.1 * random.normal();
  const RangeFit fit = fit_range(points, {.terms = RangeTerms::kBend});
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_NE(fit.warnings.front().find("cannot tell the bend from 0"), std::string::npos);
}

TEST(FitRange, WarnsOfDistancesThatLieCloseTogether) {
  Random random(4);
  const RangeModel truth{.slope = 75.1, .vanishing = 490};
  std::vector<RangePoint> points;
  for (const double d : {1.0, 1.1, 1.2, 1.3, 1.4}) {
    points.push_back({truth.position(d) + 0.1 * random.normal(), d});
  }
  const RangeFit fit = fit_range(points);
  ASSERT_FALSE(fit.warnings.empty());
  EXPECT_NE(fit.warnings.front().find("lie close together"), std::string::npos);
}

TEST(FitRange, WarnsOfAPointThatTheOthersContradict) {
  const RangeModel truth{.slope = 75.1, .vanishing = 490};
  std::vector<RangePoint> points = points_on(truth);
  Random random(5);
  for (RangePoint& p : points) p.px += 0.05 * random.normal();
  points[6].px += 3;
  const RangeFit fit = fit_range(points);
  bool named = false;
  for (const std::string& w : fit.warnings) named = named || w.find("1400 mm") != std::string::npos;
  EXPECT_TRUE(named);
}

TEST(CompareRangeModels, PutsTheTrueOneFirst) {
  Random random(6);
  const RangeModel bent{.slope = 75.1, .vanishing = 490, .bend = 1.5e-6, .centre = 320};
  std::vector<RangePoint> points = points_on(bent);
  for (RangePoint& p : points) p.px += 0.05 * random.normal();
  EXPECT_EQ(compare_range_models(points).front().terms, RangeTerms::kBend);
  std::vector<RangePoint> moved = points_on({.slope = 75.1, .vanishing = 490}, 0.04);
  for (RangePoint& p : moved) p.px += 0.05 * random.normal();
  EXPECT_EQ(compare_range_models(moved).front().terms, RangeTerms::kOrigin);
}

struct BadPoints {
  const char* name;
  std::vector<RangePoint> points;
  RangeTerms terms;
  const char* said;
};

class BadRangePoints : public testing::TestWithParam<BadPoints> {};

TEST_P(BadRangePoints, GetASentenceOfTheirOwn) {
  const BadPoints& bad = GetParam();
  const std::string said = error_of([&] { fit_range(bad.points, {.terms = bad.terms}); });
  EXPECT_NE(said.find(bad.said), std::string::npos) << said;
}

const double kNan = std::numeric_limits<double>::quiet_NaN();

INSTANTIATE_TEST_SUITE_P(
    All,
    BadRangePoints,
    testing::Values(
        BadPoints{"none", {}, RangeTerms::kPlain, "at least 3 different distances"},
        BadPoints{"two", {{100, 0.3}, {300, 1}}, RangeTerms::kPlain, "at least 3 different"},
        BadPoints{"three_for_three",
                  {{100, 0.3}, {300, 1}, {350, 2}},
                  RangeTerms::kBend,
                  "at least 4 different distances for the bend"},
        BadPoints{"equal", {{100, 1}, {101, 1}, {102, 1}}, RangeTerms::kPlain, "are equal"},
        BadPoints{"nan", {{100, 0.3}, {kNan, 1}, {350, 2}}, RangeTerms::kPlain, "finite"},
        BadPoints{"negative", {{100, 0.3}, {300, -1}, {350, 2}}, RangeTerms::kPlain, "above 0"},
        BadPoints{"beyond",
                  {{100, 0.2}, {250, 0.4}, {325, 0.8}, {430, 4}},
                  RangeTerms::kPlain,
                  "beyond"}),
    [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace facula
