// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/triangulate/zero_line.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace facula {
namespace {

constexpr std::size_t kLeastRows = 20;  // for a parabola and a median that one row cannot move
constexpr double kClean = 0.3;          // misfit up to which a row counts fully: a few sigma [px]
constexpr int kRounds = 8;              // of reweighting; the line then moves no more

/// Position of the bed's line as a parabola over the row, by least squares with Huber's weights:
/// 1, row and row^2 times the result's entries [px].
Eigen::Vector3d fit_parabola(const StripeProfile& reference) {
  const double scale = 2.0 / static_cast<double>(reference.size());
  const auto terms = [&](std::size_t r) {
    const double t = static_cast<double>(r) * scale - 1;
    return Eigen::Vector3d(1, t, t * t);
  };
  Eigen::Vector3d line = Eigen::Vector3d::Zero();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t r = 0; r < reference.size(); ++r) {
      if (reference.seen[r] == 0) continue;
      const Eigen::Vector3d t = terms(r);
      const double position = static_cast<double>(reference.position[r]);
      const double misfit = std::abs(position - line.dot(t));
      const double weight = round == 0 || misfit < kClean ? 1 : kClean / misfit;
      normal += weight * t * t.transpose();
      right += weight * position * t;
    }
    line = normal.ldlt().solve(right);
  }
  // Back from t = r * scale - 1 to powers of r.
  return {line[0] - line[1] + line[2], scale * (line[1] - 2 * line[2]), scale * scale * line[2]};
}

bool is_bed_row(const ZeroLine& zero_line, std::size_t row) {
  const int r = static_cast<int>(row);
  return std::any_of(zero_line.bed_rows.begin(), zero_line.bed_rows.end(), [&](const auto& rows) {
    return r >= rows.first && r <= rows.second;
  });
}

}  // namespace

double measure_against_bed(const ZeroLine& zero_line,
                           const StripeProfile& reference,
                           StripeProfile& profile) {
  require(reference.size() == profile.size(),
          "expected zero_line frames of the same size as the scan's frames");
  require(reference.seen_count() >= kLeastRows,
          "the stripe is seen in ",
          reference.seen_count(),
          " rows of a zero_line frame where ",
          kLeastRows,
          " are needed; check those frames and the channel");
  const Eigen::Vector3d line = fit_parabola(reference);
  std::vector<double> on_bed;
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0) continue;
    const double row = static_cast<double>(r);
    const double displacement =
        static_cast<double>(profile.position[r]) - line.dot(Eigen::Vector3d(1, row, row * row));
    profile.position[r] = static_cast<float>(displacement);
    if (is_bed_row(zero_line, r)) on_bed.push_back(displacement);
  }
  require(on_bed.size() >= kLeastRows,
          "only ",
          on_bed.size(),
          " bed rows show the stripe where ",
          kLeastRows,
          " are needed; check bed_rows in [zero_line]");
  const double shift = median(on_bed);
  for (std::size_t r = 0; r < profile.size(); ++r) {
    if (profile.seen[r] == 0) continue;
    profile.position[r] = static_cast<float>(static_cast<double>(profile.position[r]) - shift +
                                             zero_line.bed_position);
  }
  return shift;
}

}  // namespace facula
