// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/occupancy_map.hpp>

#include <array>
#include <cstddef>
#include <optional>

namespace facula {

/// What cells that no ray has met count as.
enum class UnknownCells {
  kFree,      ///< as free
  kOccupied,  ///< as occupied; so does everything outside of the map's known box
  kUnknown    ///< as neither
};

/// A box of cells; both corners belong to it.
struct CellBox {
  CellKey low{};
  CellKey high{};

  int size(std::size_t axis) const { return high[axis] - low[axis] + 1; }  ///< cells [1]
  std::size_t cells() const;                                               ///< [1]

  bool contains(const CellKey& cell) const {
    return cell[0] >= low[0] && cell[0] <= high[0] && cell[1] >= low[1] && cell[1] <= high[1] &&
           cell[2] >= low[2] && cell[2] <= high[2];
  }

  /// Place of a cell of the box among all, in the order x + nx (y + ny z) [1].
  std::size_t index(const CellKey& cell) const {
    const auto along = [&](std::size_t i) { return static_cast<std::size_t>(cell[i] - low[i]); };
    const auto nx = static_cast<std::size_t>(size(0));
    return along(0) + nx * (along(1) + static_cast<std::size_t>(size(1)) * along(2));
  }

  friend bool operator==(const CellBox&, const CellBox&) = default;
};

/// The least box that holds every known cell; none when nothing is known.
std::optional<CellBox> known_box(const OccupancyMap& map);

/// The cells that hold a box's corners [m] and those between. Throws Error when a corner is not
/// finite or beyond the 65536 cells of an axis, or when min is above max.
CellBox cell_box(const MapBox& box, double resolution);

/// The box with so many cells more on every side, as far as there are cells.
CellBox grown(const CellBox& box, int cells);

/// The cells that both have; none when there are none.
std::optional<CellBox> common_cells(const CellBox& a, const CellBox& b);

}  // namespace facula
