// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/reconstruct/filter/edge_deviation.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace facula {
namespace {

/// A step in the grid.
struct Step {
  int rows;
  int cols;
};

/// Deviation of a cell from its continued surface, in its inverse range.
struct Deviation {
  double value = 0;
  double variance_own = 0;         ///< of the cell's own measurement
  double variance_prediction = 0;  ///< of the surface continued to it
  double variance_surface = 0;     ///< of one measurement of that surface
};

class EdgeJudge {
 public:
  EdgeJudge(const PolarScan& scan, const EdgeDeviationOptions& options)
      : scan_(scan), options_(options), tangent_(std::tan(options.max_incidence)) {
    inverse_.resize(scan.valid.size());
    noise_.resize(scan.valid.size());
    for (std::size_t cell = 0; cell < scan.valid.size(); ++cell) {
      const auto col = cell / static_cast<std::size_t>(scan.rows);
      const double range = (scan.point[cell].cast<double>() - scan.sensor_origin[col]).norm();
      inverse_[cell] = 1 / range;
      noise_[cell] = scan.sigma[cell] / (range * range);
    }
  }

  /// Judges every cell that has a depth edge or a hole within `reach` steps of `outward`.
  void judge(const Step& outward, int reach, std::vector<char>& deviant) const {
    std::vector<std::optional<Deviation>> deviation(scan_.valid.size());
    for (int col = 0; col < scan_.cols; ++col) {
      for (int row = 0; row < scan_.rows; ++row) {
        const int steps = steps_to_edge(row, col, outward, reach);
        if (steps < 0) continue;
        deviation[scan_.index(row, col)] = deviation_of(row, col, outward, reach - steps);
      }
    }
    const Step along{outward.cols != 0 ? 1 : 0, outward.rows != 0 ? 1 : 0};
    const int half = outward.cols != 0 ? kStrip : 0;
    for (int col = 0; col < scan_.cols; ++col) {
      for (int row = 0; row < scan_.rows; ++row) {
        const std::size_t cell = scan_.index(row, col);
        if (deviation[cell] && deviates(deviation, row, col, along, half)) deviant[cell] = 1;
      }
    }
  }

 private:
  static constexpr double kMaxMisfit = 3;  // of a window's chi-square per cell
  static constexpr int kStrip = 3;         // cells to either side along an edge that are averaged

  bool valid(int row, int col) const {
    return row >= 0 && row < scan_.rows && col >= 0 && col < scan_.cols &&
           scan_.valid[scan_.index(row, col)] != 0;
  }

  /// Do two neighbouring cells lie on one surface?
  bool joined(int row, int col, int other_row, int other_col) const {
    if (!valid(row, col) || !valid(other_row, other_col)) return false;
    const std::size_t a = scan_.index(row, col);
    const std::size_t b = scan_.index(other_row, other_col);
    const Eigen::Vector3d p = scan_.point[a].cast<double>();
    const Eigen::Vector3d step = scan_.point[b].cast<double>() - p;
    const Eigen::Vector3d ray = (p - scan_.sensor_origin[static_cast<std::size_t>(col)]);
    const double along = step.dot(ray.stableNormalized());
    const double across = std::sqrt(std::max(0.0, step.squaredNorm() - along * along));
    return std::abs(along) <= tangent_ * across ||
           std::abs(along) <= 4 * std::hypot(scan_.sigma[a], scan_.sigma[b]);
  }

  /// Steps from the cell to the last one before an edge; -1 when there is none within reach. The
  /// rim of the grid is no edge.
  int steps_to_edge(int row, int col, const Step& outward, int reach) const {
    if (!valid(row, col)) return -1;
    for (int steps = 0; steps < reach; ++steps) {
      const int next_row = row + outward.rows;
      const int next_col = col + outward.cols;
      if (next_row < 0 || next_row >= scan_.rows || next_col < 0 || next_col >= scan_.cols) {
        return -1;
      }
      if (!joined(row, col, next_row, next_col)) return steps;
      row = next_row;
      col = next_col;
    }
    return -1;
  }

  /// Compares a cell with the surface behind it, seen from the edge; `skip` cells nearest to it are
  /// left out, for they may be mixed too.
  std::optional<Deviation> deviation_of(int row, int col, const Step& outward, int skip) const {
    if (!is_known_sigma(noise_[scan_.index(row, col)])) return std::nullopt;
    const bool columns = outward.cols != 0;
    const int depth = columns ? 3 : 9;  // cells away from the edge
    const int width = columns ? 4 : 1;  // cells to either side
    // A plane is n.u = 1 / range in directions u from the sensor; the first axis is the cell's ray.
    const Eigen::Vector3d& origin = scan_.sensor_origin[static_cast<std::size_t>(col)];
    const Eigen::Vector3d ray = scan_.point[scan_.index(row, col)].cast<double>() - origin;
    const Eigen::Matrix3d basis =
        Eigen::Quaterniond::FromTwoVectors(ray, Eigen::Vector3d::UnitX()).toRotationMatrix();
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0;
    double variance = 0;
    int cells = 0;
    int layers = 0;
    const auto add = [&](int r, int c) {
      const std::size_t cell = scan_.index(r, c);
      if (!is_known_sigma(noise_[cell])) return;
      const Eigen::Vector3d from_sensor = scan_.point[cell].cast<double>() - origin;
      const double range = from_sensor.norm();
      const Eigen::Vector3d x = basis * from_sensor / range;
      normal += x * x.transpose();
      right += x / range;
      squares += 1 / (range * range);
      variance += noise_[cell] * noise_[cell];
      ++cells;
    };
    int r = row;
    int c = col;
    for (int i = 1; i < skip + depth; ++i) {
      const int next_r = r - outward.rows;
      const int next_c = c - outward.cols;
      if (!joined(r, c, next_r, next_c)) break;
      r = next_r;
      c = next_c;
      if (i < skip) continue;
      ++layers;
      add(r, c);
      for (const int side : {1, -1}) {
        for (int k = 1; k <= width; ++k) {
          const int to_r = r + (columns ? side * k : 0);
          const int to_c = c + (columns ? 0 : side * k);
          const int from_r = to_r - (columns ? side : 0);
          const int from_c = to_c - (columns ? 0 : side);
          if (!joined(from_r, from_c, to_r, to_c)) break;
          add(to_r, to_c);
        }
      }
    }
    if (layers < 2 || cells < 6) return std::nullopt;
    return compare(
        normal, right, {squares, variance / cells, double(cells)}, scan_.index(row, col));
  }

  /// Sum of squares, mean variance and number of the cells of a fit.
  struct FitSums {
    double squares;
    double variance;
    double cells;
  };

  std::optional<Deviation> compare(const Eigen::Matrix3d& normal,
                                   const Eigen::Vector3d& right,
                                   const FitSums& sums,
                                   std::size_t cell) const {
    // A window of one column has no slope across: that coefficient is then left at zero.
    const Eigen::LDLT<Eigen::Matrix3d> solver(normal + 1e-12 * Eigen::Matrix3d::Identity());
    const Eigen::Vector3d plane = solver.solve(right);
    const Eigen::Vector3d unit = solver.solve(Eigen::Vector3d::UnitX());
    if (!plane.allFinite() || !(unit[0] > 0)) return std::nullopt;
    const double rest =
        std::max(0.0, sums.squares - right.dot(plane)) / std::max(1.0, sums.cells - 3);
    // A surface that bends within the window cannot be continued as a plane.
    if (rest > kMaxMisfit * sums.variance) return std::nullopt;
    Deviation deviation;
    deviation.value = inverse_[cell] - plane[0];
    deviation.variance_own = noise_[cell] * noise_[cell];
    deviation.variance_surface = sums.variance;
    deviation.variance_prediction = unit[0] * std::max(rest, sums.variance);
    return deviation;
  }

  /// The mean over the strip along the edge against its standard deviation. Neighbouring
  /// predictions share most of their cells, so theirs does not fall with the number.
  bool deviates(const std::vector<std::optional<Deviation>>& deviation,
                int row,
                int col,
                const Step& along,
                int half) const {
    double sum = 0;
    double own = 0;
    double prediction = 0;
    double surface = 0;
    int cells = 0;
    for (int k = -half; k <= half; ++k) {
      const int r = row + k * along.rows;
      const int c = col + k * along.cols;
      if (!valid(r, c)) continue;
      const auto& d = deviation[scan_.index(r, c)];
      if (!d) continue;
      sum += d->value;
      own += d->variance_own;
      prediction += d->variance_prediction;
      surface += d->variance_surface;
      ++cells;
    }
    const double variance = own / (cells * cells) + prediction / cells;
    // A stripe that lost light past an edge is less certain than its neighbours.
    if (own < options_.min_loss * options_.min_loss * surface) return false;
    return std::abs(sum / cells) > options_.max_deviation * std::sqrt(variance) &&
           std::abs(deviation[scan_.index(row, col)]->value) >
               0.5 * options_.max_deviation * noise_[scan_.index(row, col)];
  }

  const PolarScan& scan_;
  const EdgeDeviationOptions& options_;
  double tangent_;
  std::vector<double> inverse_;  // of the distance to the sensor [1/m]
  std::vector<double> noise_;    // its standard deviation [1/m]
};

}  // namespace

void EdgeDeviationOptions::check() const {
  require(max_incidence > 0 && max_incidence < std::numbers::pi / 2,
          "max_incidence is ",
          max_incidence,
          " rad; give an angle above 0 and below pi/2");
  require(max_deviation > 0, "max_deviation is ", max_deviation, "; give a number above 0");
  require(min_loss >= 0, "min_loss is ", min_loss, "; give a number of 0 or more");
  require(edge_rows >= 1, "edge_rows is ", edge_rows, "; give at least 1");
}

std::vector<char> edge_deviants(const PolarScan& scan, const EdgeDeviationOptions& options) {
  options.check();
  scan.check();
  std::vector<char> deviant(scan.valid.size(), 0);
  const EdgeJudge judge(scan, options);
  for (const int side : {1, -1}) {
    judge.judge({0, side}, 1, deviant);
    judge.judge({side, 0}, options.edge_rows, deviant);
  }
  return deviant;
}

}  // namespace facula
