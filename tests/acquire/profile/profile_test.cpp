// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/csv_table.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/profile/profile_bench.hpp>
#include <facula/acquire/profile/profile_polynomial_fit.hpp>
#include <facula/acquire/profile/sheet_projection_fit.hpp>
#include <facula/reconstruct/measure/profile_measures.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace facula {
namespace {

const double kNan = std::numeric_limits<double>::quiet_NaN();

// The cubic printed by source D: y [mm] against x [px].
double rod_diameter(double px) {
  return 1.362e-5 * px * px * px - 0.0037583 * px * px + 0.4828 * px - 10.6691;
}

std::vector<ProfilePoint> rods(double noise_mm = 0, std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<ProfilePoint> points;
  for (double px = 70; px <= 140; px += 7) {
    points.push_back({px, 1e-3 * (rod_diameter(px) + noise_mm * random.normal())});
  }
  return points;
}

TEST(FitProfilePolynomial, GivesBackThePublishedCubicOfTheRods) {
  const CsvTable table = CsvTable::from_file(shipped_data("tables/rod_diameters_polynomial.csv"));
  const std::vector<double> printed = table.column({"value"});
  EXPECT_EQ(printed, (std::vector<double>{1.362e-5, -0.0037583, 0.4828, -10.6691}));
  const ProfilePolynomialFit fit = fit_profile_polynomial(rods());
  EXPECT_EQ(fit.polynomial.degree(), 3);
  EXPECT_LT(fit.rms, 1e-12);
  const std::vector<double> plain = fit.polynomial.plain_coefficients();
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(1000 * plain[i] / printed[3 - i], 1, 1e-7) << i;
  }
  // The paper's plot runs from 8 to 22 mm; the polynomial does, and never turns.
  EXPECT_NEAR(rod_diameter(70), 9.4, 0.1);
  EXPECT_NEAR(rod_diameter(140), 20.6, 0.1);
  EXPECT_EQ(fit.warnings.size(), 1U) << fit.warnings.front();
}

TEST(FitProfilePolynomial, ChoosesTheDegreeThatNoiseAllows) {
  int cubic = 0;
  int too_high = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const ProfilePolynomialFit fit = fit_profile_polynomial(rods(0.02, seed));
    ASSERT_EQ(fit.trials.size(), 6U);
    EXPECT_LE(fit.trials[5].rms, fit.rms) << "a higher degree always fits its own points better";
    cubic += fit.polynomial.degree() == 3 ? 1 : 0;
    too_high += fit.polynomial.degree() > 3 ? 1 : 0;
  }
  EXPECT_GE(cubic, 80);
  EXPECT_LE(too_high, 20);
  EXPECT_EQ(fit_profile_polynomial(rods(0.02), {.degree = 1}).polynomial.degree(), 1);
}

TEST(FitProfilePolynomial, LeavesOneOutAsRefittingDoes) {
  const std::vector<ProfilePoint> points = rods(0.05);
  const ProfilePolynomialFit fit = fit_profile_polynomial(points, {.degree = 2});
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<ProfilePoint> others = points;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto without = fit_profile_polynomial(others, {.degree = 2}).polynomial;
    EXPECT_NEAR(fit.held_out[i], without.value(points[i].px) - points[i].size, 1e-12);
  }
}

TEST(FitProfilePolynomial, KnowsWhereItExtrapolatesAndWhereItTurns) {
  const ProfilePolynomialFit fit = fit_profile_polynomial(rods());
  EXPECT_FALSE(fit.polynomial.extrapolates(70));
  EXPECT_TRUE(fit.polynomial.extrapolates(69.9));
  EXPECT_TRUE(fit.polynomial.extrapolates(141));
  EXPECT_NE(fit.warnings.back().find("extrapolated"), std::string::npos);
  std::vector<ProfilePoint> hill;
  for (double px = 0; px <= 10; ++px) hill.push_back({px, 1e-3 * (30 - (px - 5) * (px - 5))});
  EXPECT_NE(fit_profile_polynomial(hill).warnings.front().find("turns at"), std::string::npos);
}

TEST(FitProfilePolynomial, RefusesWhatPointsCannotDecide) {
  const auto said = [](const std::vector<ProfilePoint>& points, int degree) {
    return error_of([&] { fit_profile_polynomial(points, {.degree = degree}); });
  };
  EXPECT_NE(said({{1, 1}, {2, 2}, {3, 3}}, 2).find("degree 2 needs 4 different positions"),
            std::string::npos);
  EXPECT_NE(said({{1, 1}, {1, 2}, {1, 3}}, 1).find("two or more different positions"),
            std::string::npos);
  EXPECT_NE(said({{1, 1}, {2, kNan}, {3, 3}}, 1).find("finite"), std::string::npos);
  EXPECT_NE(said(rods(), 40).find("degree of 1 to 12"), std::string::npos);
  EXPECT_NE(said({}, 1).find("two or more"), std::string::npos);
}

/// A camera 400 mm from the sheet, looking at it by 35 degrees: an ordinary projection.
Eigen::Matrix3d bench_projection() {
  const double tilt = 35 * std::numbers::pi / 180;
  Eigen::Matrix3d k;
  k << 2400, 0, 767.5, 0, 2400, 255.5, 0, 0, 1;
  Eigen::Matrix3d pose;  // columns: across, height, origin
  pose << 1, 0, -0.03, 0, -std::sin(tilt), 0.02, 0, -std::cos(tilt), 0.4;
  return k * pose;
}

std::vector<SheetPoint> grid(double noise_px, std::uint64_t seed = 4) {
  Random random(seed);
  const SheetProjection truth{bench_projection()};
  std::vector<SheetPoint> points;
  for (int row = 0; row < 8; ++row) {
    for (int col = 0; col < 8; ++col) {
      const Eigen::Vector2d x(0.008 * col, 0.006 * row);
      const Eigen::Vector2d pixel = truth.project(x);
      points.push_back(
          {x, {pixel.x() + noise_px * random.normal(), pixel.y() + noise_px * random.normal()}});
    }
  }
  return points;
}

TEST(FitSheetProjection, RecoversTheProjectionItWasMadeFrom) {
  const SheetProjectionFit fit = fit_sheet_projection(grid(0));
  EXPECT_LT(fit.rms_px, 1e-9);
  EXPECT_LT(fit.held_out_rms, 1e-11);
  const Eigen::Matrix3d truth = bench_projection() / bench_projection().row(2).norm();
  EXPECT_TRUE(fit.projection.image_from_sheet.isApprox(truth, 1e-9));
  const SheetProjection known{truth};
  const auto back = known.in_sheet(known.project({0.012, 0.034}));
  ASSERT_TRUE(back.has_value());
  EXPECT_LT((*back - Eigen::Vector2d(0.012, 0.034)).norm(), 1e-14);
}

/// Least squares in the picture cannot be beaten there: of 2 n equations with 8 unknowns,
/// sigma^2 (2 n - 8) stays; and no small change of the matrix lowers it.
TEST(FitSheetProjection, LeavesTheResidualThatNoiseAndUnknownsLeave) {
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const SheetProjectionFit fit = fit_sheet_projection(grid(0.1, seed));
    squares += fit.rms_px * fit.rms_px * 64 / 40;
  }
  EXPECT_NEAR(squares / (0.01 * (128 - 8)), 1, 0.05);
  const std::vector<SheetPoint> points = grid(0.1);
  const auto cost = [&](const Eigen::Matrix3d& h) {
    double sum = 0;
    for (const SheetPoint& p : points) {
      sum += (SheetProjection{h}.project(p.in_sheet) - p.pixel).squaredNorm();
    }
    return sum;
  };
  const Eigen::Matrix3d best = fit_sheet_projection(points).projection.image_from_sheet;
  for (int i = 0; i < 9; ++i) {
    for (const double change : {1e-4, -1e-4}) {
      Eigen::Matrix3d moved = best;
      moved(i / 3, i % 3) *= 1 + change;
      EXPECT_GE(cost(moved), cost(best)) << i;
    }
  }
}

TEST(FitSheetProjection, RefusesPointsThatCannotDecideIt) {
  const auto said = [](const std::vector<SheetPoint>& points) {
    return error_of([&] { fit_sheet_projection(points); });
  };
  std::vector<SheetPoint> points = grid(0);
  EXPECT_NE(said({points.begin(), points.begin() + 4}).find("at least 5 points"),
            std::string::npos);
  EXPECT_NE(said({points.begin(), points.begin() + 8}).find("lie on one line"), std::string::npos);
  EXPECT_NE(said({points.begin(), points.begin() + 9}).find("all but one"), std::string::npos);
  for (SheetPoint& p : points) p.pixel.y() = 100;
  EXPECT_NE(said(points).find("looks along the sheet"), std::string::npos);
  points[3].pixel.x() = kNan;
  EXPECT_NE(said(points).find("point 3"), std::string::npos);
}

TEST(ProfileBench, IsTheTriangleItStandsFor) {
  const ProfileBench bench{.baseline = 0.2, .lens_to_sensor = 0.016, .angle = 1.0};
  bench.check();
  for (const double shift : {-0.002, 0.0, 0.001, 0.003}) {
    const double seen = bench.angle - std::atan(shift / bench.lens_to_sensor);
    const double range = bench.baseline * std::tan(seen);
    const double reference = bench.baseline * std::tan(bench.angle);
    EXPECT_NEAR(bench.height(shift), reference - range, 1e-15);
    EXPECT_NEAR(bench.shift(bench.height(shift)), shift, 1e-16);
  }
  EXPECT_NE(error_of([] { ProfileBench{}.check(); }).find("above 0 mm"), std::string::npos);
}

/// The table's arithmetic: error is measured - actual.
TEST(FloppyStack, ErrorColumnIsMeasuredMinusActual) {
  const CsvTable table = CsvTable::from_file(shipped_data("tables/floppy_stack.csv"));
  const auto actual = table.column({"actual_mm"});
  const auto measured = table.column({"measured_mm"});
  const auto error = table.column({"error_mm"});
  for (std::size_t i = 0; i < actual.size(); ++i) {
    EXPECT_NEAR(measured[i] - actual[i], error[i], 1e-9);
  }
}

/// A stack of 1 to 12 disks on a base that is not level, seen with 0.1 px of noise through a
/// projection calibrated with 0.1 px of noise; the aim is 0.1 mm RMS where the paper has 0.36 mm.
TEST(MeasureStep, MeasuresAStackOfDisksToTenMicrometres) {
  const SheetProjection truth{bench_projection()};
  const SheetProjection calibrated = fit_sheet_projection(grid(0.1)).projection;
  Random random(8);
  double squares = 0;
  for (int count = 1; count <= 12; ++count) {
    std::vector<Eigen::Vector2d> profile;
    for (int i = 0; i < 600; ++i) {
      const double across = 0.0001 * i;
      const double tilted = 0.02 * across;
      const double height = tilted + (i >= 250 && i < 500 ? 0.0033 * count : 0);
      Eigen::Vector2d pixel = truth.project({across, height});
      pixel.y() += 0.1 * random.normal();
      const auto point = calibrated.in_sheet(pixel);
      profile.push_back(point.value_or(Eigen::Vector2d(kNan, kNan)));
    }
    const StepMeasure step = measure_step(profile, {10, 240}, {260, 490});
    const double actual = 0.0033 * count * std::cos(std::atan(0.02));
    squares += (step.thickness - actual) * (step.thickness - actual) / 12;
    EXPECT_LT(step.sigma, 2e-5);
  }
  EXPECT_LT(std::sqrt(squares), 2e-5);
}

}  // namespace
}  // namespace facula
