// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/joint_figures.hpp>
#include <facula/acquire/core/median.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

/// Stands for a residual that has no size: the point projects nowhere.
constexpr double kNowhere = 1e6;  // [px]

/// Squares of one view, or of all.
struct Sums {
  std::vector<double> point_distances;  ///< [px]
  double point2 = 0;
  double line2 = 0;
  double line_mm = 0;
  double line_mm2 = 0;
  std::size_t lines = 0;

  void add(const Sums& other) {
    point_distances.insert(
        point_distances.end(), other.point_distances.begin(), other.point_distances.end());
    point2 += other.point2;
    line2 += other.line2;
    line_mm += other.line_mm;
    line_mm2 += other.line_mm2;
    lines += other.lines;
  }
};

double finite(double value) {
  return std::isfinite(value) ? value : kNowhere;
}

Sums sums_of(const JointState& state, const std::vector<JointSight>& sights, std::size_t i) {
  Sums sums;
  for (std::size_t p = 0; p < sights[i].points.size(); ++p) {
    const double distance = finite(point_residual(state, sights, i, p).norm());
    sums.point_distances.push_back(distance);
    sums.point2 += distance * distance;
  }
  for (std::size_t p = 0; p < sights[i].lines.size(); ++p) {
    const LineResidual r = line_residual(state, sights, i, p);
    const double pixels = finite(r.pixels());
    const double mm = finite(1000 * r.metres);
    sums.line2 += pixels * pixels;
    sums.line_mm += mm;
    sums.line_mm2 += mm * mm;
    ++sums.lines;
  }
  return sums;
}

double root_mean(double squares, std::size_t count) {
  return count == 0 ? 0 : std::sqrt(squares / static_cast<double>(count));
}

JointFigures figures_of(Sums sums) {
  JointFigures figures;
  figures.point_rms = root_mean(sums.point2, sums.point_distances.size());
  figures.point_median = median(sums.point_distances);
  figures.line_rms = root_mean(sums.line2, sums.lines);
  figures.line_rms_mm = root_mean(sums.line_mm2, sums.lines);
  return figures;
}

JointViewResidual count_points(const CalibrationSet& set, const JointSight& sight) {
  JointViewResidual r;
  r.name = set.views[sight.view].points.name;
  r.points = sight.points.size();
  r.line_points = sight.lines.size();
  for (const JointPoint& p : sight.points) r.wrong_points += p.wrong ? 1 : 0;
  for (const JointLinePoint& p : sight.lines) r.wrong_line_points += p.wrong ? 1 : 0;
  return r;
}

}  // namespace

void fill_figures(const CalibrationSet& set,
                  const std::vector<JointSight>& sights,
                  const JointState& state,
                  const JointFolds& folds,
                  JointCalibration& result) {
  Sums fit;
  Sums held_out;
  for (std::size_t i = 0; i < sights.size(); ++i) {
    JointViewResidual view = count_points(set, sights[i]);
    const Sums own = sums_of(state, sights, i);
    view.point_rms = root_mean(own.point2, view.points);
    view.line_rms = root_mean(own.line2, view.line_points);
    fit.add(own);
    if (folds.decided) {
      const Sums held = sums_of(folds.states[folds.fold_of_sight[i]], sights, i);
      view.held_out_point_rms = root_mean(held.point2, view.points);
      view.held_out_line_rms = root_mean(held.line2, view.line_points);
      view.held_out_line_rms_mm = root_mean(held.line_mm2, view.line_points);
      view.held_out_line_mean_mm =
          held.lines == 0 ? 0 : held.line_mm / static_cast<double>(held.lines);
      held_out.add(held);
    }
    result.points += view.points;
    result.wrong_points += view.wrong_points;
    result.line_points += view.line_points;
    result.wrong_line_points += view.wrong_line_points;
    result.views.push_back(std::move(view));
  }
  result.fit = figures_of(std::move(fit));
  if (folds.decided) result.held_out = figures_of(std::move(held_out));
}

double fold_scatter(const JointFolds& folds, const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd& changes = folds.changes;
  if (!folds.decided || changes.rows() == 0) return 0;
  const double count = static_cast<double>(changes.cols());
  double sum = 0;
  for (Eigen::Index p = 0; p < changes.rows(); ++p) {
    const double mean = changes.row(p).mean();
    const double spread = (changes.row(p).array() - mean).square().sum();
    sum += (count - 1) / count * spread / covariance(p, p);
  }
  return std::sqrt(sum / static_cast<double>(changes.rows()));
}

}  // namespace facula
