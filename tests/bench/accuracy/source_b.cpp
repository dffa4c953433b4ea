// SPDX-License-Identifier: GPL-3.0-or-later
//
// Source B, tables 3.5 and 3.6: range error on walls before and after the pixel compensation, for
// heads with the slopes of tables 3.1 and 3.2 and the bow and tilt of tables 3.3 and 3.4; beside it
// the joint calibration, and what 0.1 px of noise leaves to anybody.
#include <facula/acquire/range/compensation_fit.hpp>
#include <facula/acquire/range/range_fit.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/triangulate/triangulate.hpp>
#include <facula/tests/bench/accuracy/board_session.hpp>
#include <facula/tests/bench/accuracy/error_statistics.hpp>
#include <facula/tests/bench/accuracy/exact_stripe.hpp>
#include <facula/tests/bench/accuracy/source_b_boxes.hpp>
#include <facula/tests/bench/accuracy/studies.hpp>
#include <facula/tests/bench/accuracy/table_file.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr double kNoise = 0.1;  // [px]

std::vector<double> wall(const Rig& rig, double depth) {
  return exact_positions(rig, 0, plane_surface(Eigen::Vector3d::UnitZ(), depth));
}

/// As the paper does it: the curve from the middle row at the distances of its table.
RangeModel fit_curve(const Rig& truth, const SourceBHead& head, Random& random) {
  std::vector<RangePoint> points;
  for (const auto& row : read_table(head.curve_fit)) {
    const double distance = row.at("true_mm") / 1000;
    const std::vector<double> line = noisy_mean(wall(truth, distance), kNoise, 20, random);
    points.push_back({line[line.size() / 2], distance});
  }
  return fit_range(points).model;
}

/// Planes from near to far, evenly spaced in the picture.
CompensationTable fit_table(const Rig& truth,
                            const RangeModel& curve,
                            double nearest,
                            Random& random) {
  constexpr int kPlanes = 16;
  constexpr double kFarthest = 5;
  std::vector<PlaneView> views;
  const double first = curve.position(nearest);
  const double last = curve.position(kFarthest);
  for (int i = 0; i < kPlanes; ++i) {
    const double depth = *curve.depth(first + (last - first) * i / (kPlanes - 1));
    views.push_back(
        {decimals(depth, 3) + " m", noisy_mean(wall(truth, depth), kNoise, 20, random)});
  }
  return fit_compensation(views).table;
}

Rig joint_rig(const Rig& truth, const SourceBHead& head, Random& random) {
  BoardSession session;
  session.board.kind = BoardKind::kCharuco;
  session.board.cols = 16;
  session.board.rows = 11;
  session.board.spacing = 0.05;
  session.nearest = head.nearest;
  session.farthest = 4.5;
  JointOptions options;
  options.bow = true;
  options.folds = 0;
  return calibrate_jointly(record_session(truth, session, random), options).rig;
}

struct WallErrors {
  ErrorStatistics before;
  ErrorStatistics after;
  ErrorStatistics joint;
};

WallErrors errors_at(double depth, const Rig& truth, const SourceBRigs& rigs, Random& random) {
  const std::vector<double> line = wall(truth, depth);
  std::vector<double> before;
  std::vector<double> after;
  std::vector<double> joint;
  constexpr int kFrames = 20;
  for (int frame = 0; frame < kFrames; ++frame) {
    const std::vector<double> seen = noisy(line, kNoise, random);
    for (std::size_t row = 0; row < seen.size(); ++row) {
      if (std::isnan(seen[row])) continue;
      const double missed = std::numeric_limits<double>::infinity();
      const int r = static_cast<int>(row);
      before.push_back(rigs.curve.depth(seen[row]).value_or(missed) - depth);
      after.push_back(rigs.curve.depth(rigs.table.corrected(r, seen[row])).value_or(missed) -
                      depth);
      const auto x = triangulate(rigs.joint, 0, {seen[row], static_cast<double>(r)}, kNoise);
      joint.push_back((x ? x->x_in_camera.z() : missed) - depth);
    }
  }
  return {statistics_of(before), statistics_of(after), statistics_of(joint)};
}

struct Worst {
  double mean = 0;   ///< after compensation over the paper's [1]
  double p99 = 0;    ///< over the paper's maximum [1]
  double joint = 0;  ///< mean over the paper's mean [1]
};

std::string mm(double metres) {
  return decimals(1000 * metres, 2);
}

StudyTable wall_table(const Rig& truth,
                      const SourceBHead& head,
                      const SourceBRigs& rigs,
                      Random& random,
                      Worst& worst) {
  StudyTable table;
  table.caption = head.name + ", walls; all in mm. Floor: z² · 0.1 px / A as standard deviation.";
  table.columns = {"z [m]",
                   "paper: mean before",
                   "here",
                   "paper: mean after",
                   "here",
                   "joint",
                   "paper: max after",
                   "here: 99 %",
                   "here: max",
                   "floor"};
  for (const auto& row : read_table(head.compensation)) {
    const double depth = row.at("true_m");
    const WallErrors e = errors_at(depth, truth, rigs, random);
    const double paper_mean = row.at("mean_after_mm") / 1000;
    const double paper_max = row.at("max_after_mm") / 1000;
    worst.mean = std::max(worst.mean, e.after.mean / paper_mean);
    worst.p99 = std::max(worst.p99, e.after.percentile_99 / paper_max);
    worst.joint = std::max(worst.joint, e.joint.mean / paper_mean);
    table.rows.push_back({decimals(depth, 1),
                          decimals(row.at("mean_before_mm"), 2),
                          mm(e.before.mean),
                          decimals(row.at("mean_after_mm"), 2),
                          mm(e.after.mean),
                          mm(e.joint.mean),
                          decimals(row.at("max_after_mm"), 2),
                          mm(e.after.percentile_99),
                          mm(e.after.largest),
                          mm(depth * depth * kNoise / std::abs(rigs.curve.slope))});
  }
  return table;
}

std::vector<SourceBHead> published_heads(const std::filesystem::path& data) {
  const std::filesystem::path tables = data / "tables";
  return {{.name = "GREEN (f·s = 760 mm²)",
           .rig = data / "rigs/head_fs760.toml",
           .nearest = 0.2,
           .curve_fit = tables / "curve_fit_fs760.csv",
           .compensation = tables / "compensation_fs760.csv",
           .fs = 760,
           .slope = 75100,
           .asked_rate = 95},
          {.name = "RED (f·s = 1500 mm²)",
           .rig = data / "rigs/head_fs1500_tables.toml",
           .nearest = 0.4,
           .curve_fit = tables / "curve_fit_fs1500.csv",
           .compensation = tables / "compensation_fs1500.csv",
           .fs = 1500,
           .slope = 137300,
           .asked_rate = 99}};
}

void add_verdicts(
    const SourceBHead& head, double slope, const Worst& worst, double box_rate, Study& study) {
  const auto add = [&](const std::string& claim, const std::string& measured, bool reached) {
    study.verdicts.push_back({head.name + ": " + claim, measured, reached});
  };
  const auto share = [](double value) { return "at worst " + decimals(value, 2) + " of it"; };
  add("slope A of its curve within 1 % of " + decimals(head.slope, 0) + " px mm",
      decimals(slope, 0) + " px mm",
      std::abs(slope / head.slope - 1) < 0.01);
  add("mean after compensation no worse than the paper's", share(worst.mean), worst.mean <= 1);
  add("99th percentile after compensation no worse than the paper's maximum",
      share(worst.p99),
      worst.p99 <= 1);
  add("joint calibration, mean at most half of the paper's",
      share(worst.joint),
      worst.joint <= 0.5);
  add("boxes within 1 % of the distance, at least " + decimals(head.asked_rate, 0) + " %",
      "at worst " + decimals(box_rate, 1) + " %",
      box_rate >= head.asked_rate);
}

}  // namespace

Study study_source_b(const StudyOptions& options) {
  Study study;
  study.title = "Source B: 3D laser radar with pixel compensation";
  study.paragraphs = {
      "Heads whose curves have the slopes of the paper's tables 3.1 and 3.2 and whose sheets bow "
      "and tilt as tables 3.3 and 3.4 show; each stripe position carries 0.1 px of noise. Curve: "
      "the plain hyperbola, from the middle row at the distances of tables 3.1 and 3.2. "
      "Compensation: walls at 16 distances, each a mean of 20 frames. Joint: camera and bowed "
      "sheet from 40 views of a board of 16 x 11 points, 50 mm apart, between the nearest distance "
      "and 4.5 m. Tested on fresh frames, all rows. The paper does not say how many rows and "
      "frames "
      "its means and maxima cover."};
  for (const SourceBHead& head : published_heads(options.data)) {
    Random random(options.seed, static_cast<std::uint64_t>(head.fs));
    const Rig truth = read_rig(head.rig);
    const RangeModel curve = fit_curve(truth, head, random);
    const SourceBRigs rigs{
        curve, fit_table(truth, curve, head.nearest, random), joint_rig(truth, head, random)};
    Worst worst;
    study.tables.push_back(wall_table(truth, head, rigs, random, worst));
    const BoxRates boxes =
        scan_boxes(truth, head, rigs, options.data / "tables/box_scan_rates.csv", random);
    study.tables.push_back(boxes.table);
    add_verdicts(head, 1000 * std::abs(curve.slope), worst, boxes.worst_rate, study);
  }
  return study;
}

}  // namespace facula
