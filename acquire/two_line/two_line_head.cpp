// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/two_line/two_line_head.hpp>

#include <cmath>

namespace facula {

std::optional<double> TwoLineHead::depth(double separation) const {
  const double depth = spacing / (separation - divergence);
  if (!(depth > 0) || !std::isfinite(depth)) return std::nullopt;
  return depth;
}

double TwoLineHead::depth_error(double depth, double separation_error) const {
  return depth * depth * std::abs(separation_error) / spacing;
}

Eigen::Vector2d TwoLineHead::in_medium(const Eigen::Vector2d& normalized) const {
  if (medium_index == 1) return normalized;
  // tan of the angle in the medium over tan in air, with sin(air) = n sin(medium).
  const double square = normalized.squaredNorm();
  const double n2 = medium_index * medium_index;
  return normalized / std::sqrt(n2 + (n2 - 1) * square);
}

void TwoLineHead::check() const {
  require(std::isfinite(spacing) && spacing > 0,
          "expected a spacing of the two lines above 0 mm, got ",
          1000 * spacing);
  require(std::isfinite(divergence) && std::abs(divergence) < 1,
          "expected a divergence of the two lines between -1 and 1, got ",
          divergence);
  require(medium_index >= 1 && medium_index <= 3,
          "expected a refractive index of 1 (air) to 3, got ",
          medium_index);
}

}  // namespace facula
