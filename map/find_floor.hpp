// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/occupancy_map.hpp>

namespace facula {

struct FloorOptions {
  double min_area = 1.0;    ///< a floor is at least this large [m^2], above 0
  double min_share = 0.25;  ///< and at least this share of the largest level surface [1], 0 to 1
  int layers = 3;           ///< of cells that tilt and noise may spread a floor over [1], 1 to 16

  /// Throws Error naming the field, its value and its bound.
  void check() const;
};

/// Where robots and tripods stand.
struct Floor {
  double height = 0;  ///< mean height of the middles of its cells, world z [m]
  double top = 0;     ///< upper face of its highest layer, world z [m]
  double area = 0;    ///< seen from above [m^2]
  double share = 0;   ///< of the columns in which the map knows anything [1]
  double spread = 0;  ///< standard deviation of the heights of its cells [m]
};

/// The lowest large level surface: occupied cells with a free one above them, counted per layer.
/// Of the runs of `layers` layers that hold enough, the lowest one is taken and moved up to where
/// its cells are most; layers of the run with less than a tenth of its fullest are not the floor's
/// but of things on it. Tables, shelves and what lies about are smaller; ceilings have nothing free
/// above. Throws Error when no run is large enough.
Floor find_floor(const OccupancyMap& map, const FloorOptions& options = {});

}  // namespace facula
