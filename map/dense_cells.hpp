// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/scan_cells.hpp>

#include <cstddef>
#include <optional>
#include <span>

namespace facula {

struct Rays {
  std::span<const Eigen::Vector3f> origins;  ///< [m]
  std::span<const Eigen::Vector3f> points;   ///< as many [m]

  std::size_t size() const { return points.size(); }
};

/// The cells of rays that lie close enough together for one bit per cell of their common box; none
/// when they do not. The same as walking them one by one.
std::optional<ScanCells> dense_cells(const Rays& rays, const CastOptions& options);

}  // namespace facula
