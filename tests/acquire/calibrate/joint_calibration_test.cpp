// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/joint_calibration.hpp>
#include <facula/acquire/calibrate/synthetic_set.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/tests/acquire/calibrate/rig_error.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

Rig shipped_rig(const char* name) {
  return read_rig(shipped_data("rigs") / name);
}

SyntheticSetOptions set_for(const Rig& rig, std::uint64_t seed) {
  SyntheticSetOptions options;
  const bool pan = rig.axis.kind == AxisKind::kPan;
  options.distance = pan ? 0.5 : 0.3;
  options.span = pan ? 0.9 : 1.6;
  options.seed = seed;
  return options;
}

JointOptions without_folds() {
  JointOptions options;
  options.folds = 0;
  return options;
}

bool any_has(const std::vector<std::string>& sentences, const std::string& part) {
  return std::any_of(sentences.begin(), sentences.end(), [&](const std::string& s) {
    return s.find(part) != std::string::npos;
  });
}

/// Without noise the answer is the truth: the model that is fitted is the model that made the set.
TEST(CalibrateJointly, IsExactWithoutNoise) {
  for (const char* name : {"ciclop_turntable.toml", "head_fs1500.toml"}) {
    const Rig truth = shipped_rig(name);
    SyntheticSetOptions options = set_for(truth, 1);
    options.point_noise = 0;
    options.line_noise = 0;
    const JointCalibration result =
        calibrate_jointly(synthesize_calibration_set(truth, options), without_folds());
    const RigError error = rig_error(result.rig, truth);
    EXPECT_LT(error.plane_angle, 1e-6) << name;
    EXPECT_LT(error.plane_distance, 1e-5) << name;
    EXPECT_LT(error.axis_angle, 1e-6) << name;
    EXPECT_LT(error.axis_distance, 1e-5) << name;
    EXPECT_NEAR(result.rig.camera.fx, truth.camera.fx, 1e-4) << name;
    EXPECT_LT(result.fit.point_rms, 1e-6) << name;
    EXPECT_EQ(result.wrong_points, 0U) << name;
  }
}

/// The bench runs 100 trials; these are enough to tell an honest covariance from one that is half
/// or twice as large: the squared error over its covariance, 10 trials x 15 parameters, has mean 1
/// and standard deviation sqrt(2 / 150) = 0.12.
TEST(CalibrateJointly, GivesACovarianceThatTheErrorsObey) {
  double squared = 0;
  double parameters = 0;
  double inside = 0;
  double chi_squared = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const char* name : {"ciclop_turntable.toml", "head_fs1500.toml"}) {
      const Rig truth = shipped_rig(name);
      JointOptions options = without_folds();
      options.point_sigma = 0.1;
      options.line_sigma_ratio = 1;
      const JointCalibration result =
          calibrate_jointly(synthesize_calibration_set(truth, set_for(truth, seed)), options);
      const RigError error = rig_error(result.rig, truth);
      squared += error.squared;
      parameters += static_cast<double>(error.parameters);
      inside += static_cast<double>(error.inside);
      chi_squared += result.reduced_chi_squared / 10;
    }
  }
  EXPECT_NEAR(squared / parameters, 1, 0.36);
  EXPECT_GE(inside / parameters, 0.90);
  EXPECT_NEAR(chi_squared, 1, 0.02);
}

TEST(CalibrateJointly, EstimatesTheNoiseAndHoldsViewsOut) {
  const Rig truth = shipped_rig("ciclop_turntable.toml");
  SyntheticSetOptions options = set_for(truth, 3);
  options.point_noise = 0.2;
  const JointCalibration result = calibrate_jointly(synthesize_calibration_set(truth, options));
  EXPECT_NEAR(result.point_sigma, 0.2, 0.01);
  EXPECT_NEAR(result.line_sigma_ratio, 1, 0.06);
  ASSERT_TRUE(result.held_out.has_value());
  // sqrt(2) * 0.2 px, a little more where the rig comes from the other views.
  EXPECT_GT(result.held_out->point_rms, result.fit.point_rms);
  EXPECT_NEAR(result.held_out->point_rms, 0.283, 0.03);
  EXPECT_GT(result.held_out->line_rms, result.fit.line_rms);
  EXPECT_NEAR(result.held_out->line_rms, 0.1, 0.1);
  EXPECT_GT(result.fold_scatter, 0.4);
  EXPECT_LT(result.fold_scatter, 2.0);
}

/// Wrong points are left out of the fit and stay in the figures.
TEST(CalibrateJointly, StandsOnePointInTwentyWrong) {
  const Rig truth = shipped_rig("ciclop_turntable.toml");
  SyntheticSetOptions options = set_for(truth, 5);
  options.wrong_share = 0.05;
  JointOptions joint;
  joint.camera = truth.camera;
  const JointCalibration result =
      calibrate_jointly(synthesize_calibration_set(truth, options), joint);
  const double share =
      static_cast<double>(result.wrong_points) / static_cast<double>(result.points);
  EXPECT_NEAR(share, 0.05, 0.02);
  EXPECT_NEAR(result.point_sigma, 0.1, 0.01);
  const RigError error = rig_error(result.rig, truth);
  EXPECT_LT(error.plane_angle, 0.06);
  EXPECT_LT(error.axis_angle, 0.06);
  EXPECT_LT(error.squared / static_cast<double>(error.parameters), 2.5);
  ASSERT_TRUE(result.held_out.has_value());
  EXPECT_GT(result.held_out->point_rms, 1) << "the figure is over all points";
  EXPECT_NEAR(result.held_out->point_median, 0.118, 0.03) << "Rayleigh's median of 0.1 px";
}

TEST(CalibrateJointly, FindsThatTwoBoardsContradictAndLeavesThemSo) {
  const Rig truth = shipped_rig("ciclop_turntable.toml");
  SyntheticSetOptions options = set_for(truth, 2);
  options.boards = 2;
  options.second_scale = 1.02;
  const JointCalibration result =
      calibrate_jointly(synthesize_calibration_set(truth, options), without_folds());
  ASSERT_EQ(result.scales.size(), 1U);
  EXPECT_TRUE(result.scales[0].conflict);
  EXPECT_NEAR(result.scales[0].factor, 1.02, 4 * result.scales[0].sigma);
  EXPECT_LT(result.scales[0].sigma, 0.002);
  EXPECT_TRUE(any_has(result.warnings, "sizes of the boards contradict"));
  // In the first board's size everything is right.
  const RigError error = rig_error(result.rig, truth);
  EXPECT_LT(error.plane_distance, 0.1);
  EXPECT_LT(error.squared / static_cast<double>(error.parameters), 2.5);
}

TEST(CalibrateJointly, SeesNoContradictionBetweenBoardsThatAgree) {
  const Rig truth = shipped_rig("ciclop_turntable.toml");
  SyntheticSetOptions options = set_for(truth, 4);
  options.boards = 2;
  const JointCalibration result =
      calibrate_jointly(synthesize_calibration_set(truth, options), without_folds());
  ASSERT_EQ(result.scales.size(), 1U);
  EXPECT_TRUE(result.scales[0].decided);
  EXPECT_FALSE(result.scales[0].conflict);
  EXPECT_NEAR(result.scales[0].factor, 1, 4 * result.scales[0].sigma);
  EXPECT_FALSE(any_has(result.warnings, "contradict"));
}

TEST(CalibrateJointly, CannotCompareBoardsThatNothingTies) {
  const Rig truth = shipped_rig("ciclop_turntable.toml");
  SyntheticSetOptions options = set_for(truth, 4);
  options.boards = 2;
  CalibrationSet set = synthesize_calibration_set(truth, options);
  for (JointView& view : set.views) {
    if (view.board == 1) view.lines.clear();
  }
  const JointCalibration result = calibrate_jointly(set, without_folds());
  ASSERT_EQ(result.scales.size(), 1U);
  EXPECT_FALSE(result.scales[0].decided);
  EXPECT_TRUE(any_has(result.warnings, "nothing compares the size of board 2"));
}

TEST(CalibrateJointly, EstimatesTheBowOfASheet) {
  Rig truth = shipped_rig("head_fs1500.toml");
  truth.lasers[0].bow = 0.03;
  JointOptions options = without_folds();
  options.bow = true;
  const JointCalibration result =
      calibrate_jointly(synthesize_calibration_set(truth, set_for(truth, 6)), options);
  const double sigma = parameter_sigma(result.rig, "laser.808 nm.bow_rad");
  EXPECT_LT(sigma, 0.006);
  EXPECT_NEAR(result.rig.lasers[0].bow, 0.03, 4 * sigma);
}

TEST(CalibrateJointly, FindsALinearAxis) {
  Rig truth = shipped_rig("head_fs1500.toml");
  truth.axis = {};
  truth.axis.kind = AxisKind::kLinear;
  truth.axis.direction = Eigen::Vector3d(0.95, 0.1, 0.2).normalized();
  SyntheticSetOptions options = set_for(truth, 7);
  options.span = 0.2;
  const JointCalibration result =
      calibrate_jointly(synthesize_calibration_set(truth, options), without_folds());
  const RigError error = rig_error(result.rig, truth);
  EXPECT_LT(error.axis_angle, 0.1);
  EXPECT_LT(error.squared / static_cast<double>(error.parameters), 2.5);
}

/// Steps that are off by a tenth of a degree: said, they cost little; unsaid, they show.
TEST(CalibrateJointly, TakesTheUncertaintyOfThePositionsIntoAccount) {
  const Rig truth = shipped_rig("ciclop_turntable.toml");
  CalibrationSet set = synthesize_calibration_set(truth, set_for(truth, 8));
  constexpr double kPlay = 0.1 * M_PI / 180;
  int k = 0;
  for (JointView& view : set.views) {
    if (view.position) *view.position += kPlay * std::sin(2.4 * ++k);
  }
  JointOptions options = without_folds();
  options.position_sigma = kPlay;
  const JointCalibration said = calibrate_jointly(set, options);
  const JointCalibration unsaid = calibrate_jointly(set, without_folds());
  EXPECT_NEAR(said.point_sigma, 0.1, 0.01);
  EXPECT_GT(unsaid.point_sigma, 0.15);
}

TEST(CalibrateJointly, SaysWhatASetCannotDecide) {
  const Rig truth = shipped_rig("ciclop_turntable.toml");
  const CalibrationSet good = synthesize_calibration_set(truth, set_for(truth, 9));
  const auto complaint = [&](const std::function<void(CalibrationSet&)>& spoil) {
    CalibrationSet set = good;
    spoil(set);
    return error_of([&] { calibrate_jointly(set, without_folds()); });
  };
  using Set = CalibrationSet;
  EXPECT_NE(complaint([](Set& s) { s.boards.clear(); }).find("at least one board"),
            std::string::npos);
  EXPECT_NE(complaint([](Set& s) { s.views.clear(); }).find("with views"), std::string::npos);
  EXPECT_NE(complaint([](Set& s) { s.axis = AxisKind::kNone; }).find("kind of axis"),
            std::string::npos);
  EXPECT_NE(complaint([](Set& s) {
              for (JointView& v : s.views) v.position.reset();
            }).find("no view has a position"),
            std::string::npos);
  EXPECT_NE(complaint([](Set& s) {
              for (JointView& v : s.views) v.lines.clear();
            }).find("laser 'right'"),
            std::string::npos);
  EXPECT_NE(complaint([](Set& s) { s.views[2].board = 4; }).find("hand 3"), std::string::npos);
  EXPECT_NE(complaint([](Set& s) { s.views[2].points.ids[0] = 1000; }).find("hand 3"),
            std::string::npos);
  EXPECT_NE(complaint([](Set& s) { s.views[2].points.pixels.pop_back(); }).find("hand 3"),
            std::string::npos);
  EXPECT_NE(complaint([](Set& s) { s.views[2].lines[0].laser = 3; }).find("laser below 1"),
            std::string::npos);
  EXPECT_NE(complaint([](Set& s) { s.views[2].lines[0].sigmas[0] = 0; }).find("above 0"),
            std::string::npos);
  // A line seen on one pose of a board only: the sheet can turn about it.
  const std::string one_line = complaint([](Set& s) {
    for (std::size_t v = 1; v < s.views.size(); ++v) s.views[v].lines.clear();
  });
  EXPECT_NE(one_line.find("laser 'right'"), std::string::npos) << one_line;
}

TEST(CalibrateJointly, NamesTheViewsItRejects) {
  const Rig truth = shipped_rig("ciclop_turntable.toml");
  CalibrationSet set = synthesize_calibration_set(truth, set_for(truth, 10));
  set.views[1].points.failure = "nothing like a board";
  const JointCalibration result = calibrate_jointly(set, without_folds());
  ASSERT_EQ(result.rejected.size(), 1U);
  EXPECT_EQ(result.rejected[0], "view 'hand 2': nothing like a board");
  EXPECT_EQ(result.views.size(), set.views.size() - 1);
}

TEST(CalibrateJointly, DoesNotDependOnTheNumberOfThreads) {
  const Rig truth = shipped_rig("head_fs1500.toml");
  SyntheticSetOptions options = set_for(truth, 11);
  options.hand_views = 8;
  const CalibrationSet set = synthesize_calibration_set(truth, options);
  JointOptions one;
  one.num_threads = 1;
  one.folds = 2;
  JointOptions two = one;
  two.num_threads = 2;
  const JointCalibration a = calibrate_jointly(set, one);
  const JointCalibration b = calibrate_jointly(set, two);
  EXPECT_EQ(a.rig.camera.fx, b.rig.camera.fx);
  EXPECT_EQ(a.rig.covariance->matrix, b.rig.covariance->matrix);
  EXPECT_EQ(a.held_out->point_rms, b.held_out->point_rms);
}

}  // namespace
}  // namespace facula
