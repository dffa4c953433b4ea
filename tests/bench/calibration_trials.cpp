// SPDX-License-Identifier: GPL-3.0-or-later
// Joint calibration of simulated rigs with 0.1 px of noise, again and again:
//   calibration_trials [TRIALS]        100 unless given
// prints how far sheets and axis come out from the truth and how honest the covariance is.
#include <facula/acquire/calibrate/joint_calibration.hpp>
#include <facula/acquire/calibrate/synthetic_set.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/tests/acquire/calibrate/rig_error.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <string>
#include <vector>

namespace facula {
namespace {

struct Spread {
  std::vector<double> values;
  double root_mean_square() const {
    double sum = 0;
    for (const double v : values) sum += v * v;
    return std::sqrt(sum / static_cast<double>(values.size()));
  }
  double quantile(double share) {
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }
};

/// The session that docs/calibration.md recommends: boards as wide as their distance, tilted,
/// partly out of the image (ChArUco), a line point per row or two of the picture.
SyntheticSetOptions options_for(AxisKind kind) {
  const bool pan = kind == AxisKind::kPan;
  SyntheticSetOptions options;
  options.distance = pan ? 0.4 : 0.3;
  options.board_share = pan ? 1.0 : 0.53;
  options.span = pan ? 1.2 : 2.0;
  options.axis_tilt = 0.9;
  options.hand_views = pan ? 24 : 16;
  options.placements = pan ? 12 : 8;
  options.positions = 9;
  options.line_points = 240;
  options.board_cols = pan ? 14 : 11;
  options.board_rows = pan ? 10 : 8;
  return options;
}

/// 95.45 % of chi squared with n degrees of freedom lie below this (Wilson and Hilferty 1931).
double chi_squared_bound(std::size_t n) {
  const double part = 2.0 / (9.0 * static_cast<double>(n));
  return static_cast<double>(n) * std::pow(1 - part + 1.6901 * std::sqrt(part), 3);
}

/// Counts per parameter whether the truth lies within 2 sigma.
void count_inside(const Rig& found, const Rig& truth, std::map<std::string, int>& counts) {
  const RigCovariance& covariance = *found.covariance;
  const Eigen::VectorXd errors = parameter_errors(found, truth, covariance.parameters);
  for (Eigen::Index i = 0; i < errors.size(); ++i) {
    const bool inside = std::abs(errors[i]) <= 2 * std::sqrt(covariance.matrix(i, i));
    counts[covariance.parameters[static_cast<std::size_t>(i)]] += inside ? 1 : 0;
  }
}

void print(const char* name, Spread& spread, double limit) {
  std::printf("  %-18s rms %.4f  95 %% %.4f  largest %.4f  asked %.2f\n",
              name,
              spread.root_mean_square(),
              spread.quantile(0.95),
              spread.quantile(1),
              limit);
}

struct Summary {
  Spread plane_angle;
  Spread plane_distance;
  Spread axis_angle;
  Spread axis_distance;
  std::size_t inside = 0;
  std::size_t parameters = 0;
  int whole_inside = 0;
  std::map<std::string, int> inside_by_name;
  double squared = 0;
  double chi_squared = 0;
  double views = 0;
  double points = 0;
  double line_points = 0;
  double seconds = 0;
};

void run_trial(const Rig& truth, const SyntheticSetOptions& options, Summary& sum) {
  const CalibrationSet set = synthesize_calibration_set(truth, options);
  const std::clock_t begin = std::clock();
  JointOptions joint;
  joint.point_sigma = options.point_noise;
  joint.line_sigma_ratio = 1;
  joint.folds = 0;
  const JointCalibration result = calibrate_jointly(set, joint);
  sum.seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  const RigError error = rig_error(result.rig, truth);
  sum.plane_angle.values.push_back(error.plane_angle);
  sum.plane_distance.values.push_back(error.plane_distance);
  sum.axis_angle.values.push_back(error.axis_angle);
  sum.axis_distance.values.push_back(error.axis_distance);
  sum.inside += error.inside;
  sum.parameters += error.parameters;
  // As many sigmas as hold 95.45 %, the share of 2 sigma, of all parameters at once.
  sum.whole_inside += error.squared <= chi_squared_bound(error.parameters) ? 1 : 0;
  count_inside(result.rig, truth, sum.inside_by_name);
  sum.squared += error.squared / static_cast<double>(error.parameters);
  sum.chi_squared += result.reduced_chi_squared;
  sum.views += static_cast<double>(set.views.size());
  sum.points += static_cast<double>(result.points);
  sum.line_points += static_cast<double>(result.line_points);
}

void run_trials(const char* file, int trials) {
  const Rig truth = read_rig(shipped_data("rigs") / file);
  SyntheticSetOptions options = options_for(truth.axis.kind);
  Summary sum;
  for (int t = 0; t < trials; ++t) {
    options.seed = static_cast<std::uint64_t>(t + 1);
    run_trial(truth, options, sum);
  }
  const double n = trials;
  std::printf(
      "%s: %d trials, %.0f views of %d x %d points, %.0f points and %.0f line points seen, "
      "%.2f s of one core each\n",
      truth.name.c_str(),
      trials,
      sum.views / n,
      options.board_cols,
      options.board_rows,
      sum.points / n,
      sum.line_points / n,
      sum.seconds / n);
  print("plane angle deg", sum.plane_angle, 0.02);
  print("plane distance mm", sum.plane_distance, 0.05);
  print("axis angle deg", sum.axis_angle, 0.02);
  print("axis distance mm", sum.axis_distance, 0.05);
  const auto worst = std::min_element(
      sum.inside_by_name.begin(), sum.inside_by_name.end(), [](const auto& a, const auto& b) {
        return a.second < b.second;
      });
  std::printf(
      "  parameters inside 2 sigma %.1f %%, the worst one (%s) in %d of %d trials; all at once (95 "
      "%% ellipsoid) in %d\n"
      "  error squared over its covariance, per parameter %.3f; reduced chi squared %.4f\n",
      100.0 * static_cast<double>(sum.inside) / static_cast<double>(sum.parameters),
      worst->first.c_str(),
      worst->second,
      trials,
      sum.whole_inside,
      sum.squared / n,
      sum.chi_squared / n);
}

}  // namespace
}  // namespace facula

int main(int count, char** words) {
  const bool small = std::getenv("FACULA_BENCH_SMALL") != nullptr;
  int trials = small ? 1 : 100;
  if (count > 1) trials = std::max(1, std::atoi(words[1]));
  facula::run_trials("ciclop_turntable.toml", trials);
  facula::run_trials("head_fs1500.toml", trials);
  return 0;
}
