// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_key.hpp>

#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

namespace facula {

/// The cell of a point [m], as OctoMap 1.9.7 finds it; none where the point is not finite or beyond
/// the 65536 cells that an axis has.
inline std::optional<CellKey> cell_of(const Eigen::Vector3d& x, double resolution) {
  const double cells_per_metre = 1.0 / resolution;
  CellKey cell;
  for (int i = 0; i < 3; ++i) {
    const double index = std::floor(cells_per_metre * x[i]);
    if (!(index >= -kCentreKey && index < kCentreKey)) return std::nullopt;  // catches NaN too
    cell[static_cast<std::size_t>(i)] = static_cast<int>(index) + kCentreKey;
  }
  return cell;
}

/// Middle of a cell [m].
inline Eigen::Vector3d centre_of(const CellKey& cell, double resolution) {
  const auto along = [&](std::size_t i) { return (cell[i] - kCentreKey + 0.5) * resolution; };
  return {along(0), along(1), along(2)};
}

}  // namespace facula
