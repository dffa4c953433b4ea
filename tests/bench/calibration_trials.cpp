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

void print(const char* name, Spread& spread, double limit) {
  std::printf("  %-18s rms %.4f  95 %% %.4f  largest %.4f  asked %.2f\n",
              name,
              spread.root_mean_square(),
              spread.quantile(0.95),
              spread.quantile(1),
              limit);
}

void run_trials(const char* file, int trials) {
  const Rig truth = read_rig(shipped_data("rigs") / file);
  SyntheticSetOptions options = options_for(truth.axis.kind);
  Spread plane_angle;
  Spread plane_distance;
  Spread axis_angle;
  Spread axis_distance;
  std::size_t inside = 0;
  std::size_t parameters = 0;
  int good_trials = 0;
  double squared = 0;
  double chi_squared = 0;
  double views = 0;
  double line_points = 0;
  double points = 0;
  double seconds = 0;
  for (int t = 0; t < trials; ++t) {
    options.seed = static_cast<std::uint64_t>(t + 1);
    const CalibrationSet set = synthesize_calibration_set(truth, options);
    const std::clock_t begin = std::clock();
    JointOptions joint;
    joint.point_sigma = options.point_noise;
    joint.line_sigma_ratio = 1;
    joint.folds = 0;
    const JointCalibration result = calibrate_jointly(set, joint);
    seconds += static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    const RigError error = rig_error(result.rig, truth);
    plane_angle.values.push_back(error.plane_angle);
    plane_distance.values.push_back(error.plane_distance);
    axis_angle.values.push_back(error.axis_angle);
    axis_distance.values.push_back(error.axis_distance);
    inside += error.inside;
    parameters += error.parameters;
    good_trials += 10 * error.inside >= 9 * error.parameters ? 1 : 0;
    squared += error.squared / static_cast<double>(error.parameters);
    chi_squared += result.reduced_chi_squared;
    views += static_cast<double>(set.views.size());
    points += static_cast<double>(result.points);
    line_points += static_cast<double>(result.line_points);
  }
  const double n = trials;
  std::printf(
      "%s: %d trials, %.0f views of %d x %d points, %.0f points and %.0f line points seen, "
      "%.2f s of one core each\n",
      truth.name.c_str(),
      trials,
      views / n,
      options.board_cols,
      options.board_rows,
      points / n,
      line_points / n,
      seconds / n);
  print("plane angle deg", plane_angle, 0.02);
  print("plane distance mm", plane_distance, 0.05);
  print("axis angle deg", axis_angle, 0.02);
  print("axis distance mm", axis_distance, 0.05);
  std::printf(
      "  parameters inside 2 sigma %.1f %%, trials with 9 of 10 inside %d of %d\n"
      "  error squared over its covariance, per parameter %.3f; reduced chi squared %.4f\n",
      100.0 * static_cast<double>(inside) / static_cast<double>(parameters),
      good_trials,
      trials,
      squared / n,
      chi_squared / n);
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
