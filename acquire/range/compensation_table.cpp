// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/range/compensation_table.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <Eigen/Core>

namespace facula {
namespace {

/// A line beyond the picture: so far away that its weight is nothing.
constexpr double kNowhere = 1e15;

using Column = Eigen::Map<const Eigen::ArrayXd>;

void check_planes(const std::vector<CompensationTable::Plane>& planes, int window) {
  require(!planes.empty(), "expected at least one plane in the compensation table, got none");
  require(window >= 0 && window <= 1000,
          "expected a window of 0 to 1000 lines in the compensation table, got ",
          window);
  const std::size_t lines = planes.front().measured.size();
  require(lines > 0, "expected positions for every line of the picture in the compensation table");
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const auto& plane = planes[i];
    require(plane.measured.size() == lines,
            "plane ",
            i,
            " of the compensation table: expected ",
            lines,
            " lines as in plane 0, got ",
            plane.measured.size());
    require(std::isfinite(plane.position),
            "plane ",
            i,
            " of the compensation table: expected a finite position, got ",
            plane.position);
    for (std::size_t u = 0; u < lines; ++u) {
      require(std::isfinite(plane.measured[u]),
              "plane ",
              i,
              " of the compensation table, line ",
              u,
              ": expected a finite position, got ",
              plane.measured[u]);
      require(i == 0 || planes[i - 1].measured[u] < plane.measured[u],
              "planes ",
              i - 1,
              " and ",
              i,
              " of the compensation table are out of order in line ",
              u,
              " (",
              i == 0 ? 0.0 : planes[i - 1].measured[u],
              " and ",
              plane.measured[u],
              " px): positions must grow from plane to plane in every line; leave out one of two "
              "planes that lie so close together");
    }
  }
}

}  // namespace

CompensationTable::CompensationTable(std::vector<Plane> planes, int window)
    : planes_(std::move(planes)), window_(window) {
  check_planes(planes_, window);
  const std::size_t count = planes_.size();
  const std::size_t lines = planes_.front().measured.size();
  const auto s = static_cast<std::size_t>(window);
  for (int m = -window; m <= window; ++m) squares_.push_back(static_cast<double>(m) * m);
  padded_ = lines + 2 * s;
  by_line_.resize(lines * count);
  positions_.assign(padded_ * count, kNowhere);
  shifts_.assign(padded_ * count, 0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t u = 0; u < lines; ++u) {
      const double measured = planes_[i].measured[u];
      by_line_[u * count + i] = measured;
      positions_[i * padded_ + s + u] = measured;
      shifts_[i * padded_ + s + u] = planes_[i].position - measured;
    }
  }
}

CompensationTable::Correction CompensationTable::correction(int line, double position) const {
  const auto u = static_cast<std::size_t>(std::clamp(line, 0, lines() - 1));
  const std::size_t count = planes_.size();
  const double* own = by_line_.data() + u * count;
  const auto above = static_cast<std::size_t>(std::upper_bound(own, own + count, position) - own);
  const std::size_t first = above == 0 ? 0 : above - 1;
  const std::size_t last = std::min(above, count - 1);
  const auto size = static_cast<Eigen::Index>(squares_.size());
  const Column squares(squares_.data(), size);
  double weights = 0;
  double sum = 0;
  for (std::size_t i = first; i <= last; ++i) {
    const Column z(positions_.data() + i * padded_ + u, size);
    const Column shift(shifts_.data() + i * padded_ + u, size);
    // A point of the table itself: L = 0, and its own correction is the answer (2.7).
    const double own_shift = planes_[i].position - own[i];
    if (std::abs(position - own[i]) < 1e-9) return {own_shift, 0};
    const Eigen::Array<double, Eigen::Dynamic, 1, 0, 2001, 1> weight =
        ((z - position).square() + squares).sqrt().inverse();
    weights += weight.sum();
    sum += (weight * shift).sum();
  }
  Correction result{sum / weights, 0};
  if (first != last) {
    const double before = planes_[first].position - own[first];
    const double after = planes_[last].position - own[last];
    result.slope = (after - before) / (own[last] - own[first]);
  }
  return result;
}

}  // namespace facula
