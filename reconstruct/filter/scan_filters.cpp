// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/edge_deviation.hpp>
#include <facula/reconstruct/filter/scan_filters.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace facula {
namespace {

/// The segment between two neighbouring points as the camera sees it.
struct Step {
  double depth = 0;      ///< range of the second minus range of the first, from the camera [m]
  double incidence = 0;  ///< between the ray and the segment's normal [rad], in [0, pi/2]
  double range = 0;      ///< of the nearer point [m]
};

Step step_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& eye) {
  const double range_a = (a - eye).norm();
  const double range_b = (b - eye).norm();
  const Eigen::Vector3d segment = b - a;
  const Eigen::Vector3d ray = (a + b) / 2 - eye;
  const double along = std::abs(segment.dot(ray));
  const double across = segment.cross(ray).norm();
  return {range_b - range_a, std::atan2(along, across), std::min(range_a, range_b)};
}

class MixedPointJudge {
 public:
  MixedPointJudge(const PolarScan& scan, const MixedPointOptions& options)
      : scan_(scan), options_(options), mixed_(scan.point.size(), 0) {}

  /// Splits the column at its depth edges and condemns what hangs between them.
  void judge_column(int col) {
    std::vector<std::size_t> cells;
    for (int row = 0; row < scan_.rows; ++row) {
      const std::size_t cell = scan_.index(row, col);
      if (scan_.valid[cell] != 0) cells.push_back(cell);
    }
    const Eigen::Vector3d& eye = scan_.sensor_origin[static_cast<std::size_t>(col)];
    std::size_t begin = 0;
    bool edge_before = false;
    while (begin < cells.size()) {
      std::size_t end = begin + 1;
      while (end < cells.size() && !is_edge(cells[end - 1], cells[end], eye)) ++end;
      const bool edge_after = end < cells.size();
      const std::vector<std::size_t> run(cells.begin() + static_cast<std::ptrdiff_t>(begin),
                                         cells.begin() + static_cast<std::ptrdiff_t>(end));
      judge_run(run, edge_before, edge_after, eye);
      edge_before = edge_after;
      begin = end;
    }
  }

  /// A stripe along a depth edge mixes a whole column at once. A cell with an edge to the columns
  /// on either side is mixed when it lies between them in depth; a thin rod lies before both.
  void judge_row_neighbours(int row, int col) {
    const std::size_t left = scan_.index(row, col - 1);
    const std::size_t cell = scan_.index(row, col);
    const std::size_t right = scan_.index(row, col + 1);
    if (!scan_.valid[left] || !scan_.valid[cell] || !scan_.valid[right]) return;
    const Eigen::Vector3d& eye = scan_.sensor_origin[static_cast<std::size_t>(col)];
    if (!is_edge(left, cell, eye) || !is_edge(cell, right, eye)) return;
    const double before = step(left, cell, eye).depth;
    const double after = step(cell, right, eye).depth;
    if (before * after > 0) mixed_[cell] = 1;
  }

  const std::vector<char>& mixed() const { return mixed_; }

 private:
  Step step(std::size_t a, std::size_t b, const Eigen::Vector3d& eye) const {
    return step_between(scan_.point[a].cast<double>(), scan_.point[b].cast<double>(), eye);
  }

  bool is_edge(std::size_t a, std::size_t b, const Eigen::Vector3d& eye) const {
    const Step s = step(a, b, eye);
    return std::abs(s.depth) > std::max(options_.min_jump, options_.jump_ratio * s.range) &&
           s.incidence > options_.max_incidence;
  }

  void judge_run(const std::vector<std::size_t>& run,
                 bool edge_before,
                 bool edge_after,
                 const Eigen::Vector3d& eye) {
    if (!edge_before && !edge_after) return;
    const auto in_line = [&](std::size_t a, std::size_t b) {
      return step(a, b, eye).incidence > options_.max_incidence;
    };
    std::size_t begin = 0;
    std::size_t end = run.size();
    while (edge_before && end - begin >= 2 && in_line(run[begin], run[begin + 1])) ++begin;
    while (edge_after && end - begin >= 2 && in_line(run[end - 2], run[end - 1])) --end;
    const bool too_short = end - begin < static_cast<std::size_t>(options_.min_run);
    for (std::size_t i = 0; i < run.size(); ++i) {
      if (too_short || i < begin || i >= end) mixed_[run[i]] = 1;
    }
  }

  const PolarScan& scan_;
  const MixedPointOptions& options_;
  std::vector<char> mixed_;
};

/// One entry per cell, 1 where it hangs between the two sides of an edge.
std::vector<char> between_edges(const PolarScan& scan, const MixedPointOptions& options) {
  MixedPointJudge judge(scan, options);
  for (int col = 0; col < scan.cols; ++col) judge.judge_column(col);
  for (int col = 1; col + 1 < scan.cols; ++col) {
    for (int row = 0; row < scan.rows; ++row) judge.judge_row_neighbours(row, col);
  }
  return judge.mixed();
}

}  // namespace

void MixedPointOptions::check() const {
  require(max_incidence > 0 && max_incidence < std::numbers::pi / 2,
          "max_incidence is ",
          max_incidence,
          " rad; give an angle above 0 and below pi/2");
  require(min_jump >= 0 && std::isfinite(min_jump),
          "min_jump is ",
          min_jump,
          " m; give a length of 0 or more");
  require(jump_ratio >= 0 && std::isfinite(jump_ratio),
          "jump_ratio is ",
          jump_ratio,
          "; give a share of 0 or more");
  require(min_run >= 1, "min_run is ", min_run, "; give at least 1");
  require(max_deviation >= 0, "max_deviation is ", max_deviation, "; give a number of 0 or more");
}

FilterVerdict mixed_points(const PolarScan& scan, const MixedPointOptions& options) {
  options.check();
  scan.check();
  std::vector<char> mixed = between_edges(scan, options);
  if (options.max_deviation > 0) {
    PolarScan rest = scan;
    for (std::size_t cell = 0; cell < mixed.size(); ++cell) {
      if (mixed[cell] != 0) rest.clear(cell);
    }
    const EdgeDeviationOptions deviation{options.max_incidence, options.max_deviation};
    const std::vector<char> deviant = edge_deviants(rest, deviation);
    for (std::size_t cell = 0; cell < mixed.size(); ++cell) mixed[cell] |= deviant[cell];
  }
  FilterVerdict verdict(scan.valid_count());
  std::size_t point = 0;
  for (std::size_t cell = 0; cell < mixed.size(); ++cell) {
    if (scan.valid[cell] == 0) continue;
    if (mixed[cell] != 0) verdict.remove(point, Removal::kMixed);
    ++point;
  }
  return verdict;
}

std::size_t remove_mixed_points(PolarScan& scan, const MixedPointOptions& options) {
  const FilterVerdict verdict = mixed_points(scan, options);
  clear_removed(scan, verdict);
  return verdict.removed();
}

}  // namespace facula
