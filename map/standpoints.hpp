// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/find_floor.hpp>
#include <facula/map/occupancy_map.hpp>

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct StandpointOptions {
  double scanner_height = 1.2;  ///< of the scanner's centre above the floor [m], above 0
  double clearance = 0.3;       ///< radius around the tripod without obstacles [m], 0 or more
  double spacing = 0.5;         ///< of the lattice, as long as `most` are enough [m], above 0
  std::size_t most = 200;       ///< standpoints of the lattice, at least 1; more thin out [1]

  /// Throws Error naming the field, its value and its bound.
  void check() const;
};

/// Where a tripod could stand, and a lattice of places to try.
struct StandArea {
  int rows = 0;                                      ///< [1]
  int cols = 0;                                      ///< [1]
  double resolution = 0;                             ///< edge of a cell [m]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower left corner, world x and y [m]
  double height = 0;                                 ///< of the scanner, world z [m]
  std::vector<bool> inside;                          ///< row by row from the top
  std::vector<std::size_t> lattice;                  ///< cells of the lattice, ascending
  int stride = 1;                                    ///< of the lattice [cells]

  /// Where the scanner is, when the tripod stands in the middle of a cell [m].
  Eigen::Vector3d position(std::size_t cell) const;

  /// The places inside among the eight at `step` cells to the sides of a cell and its corners.
  std::vector<std::size_t> around(std::size_t cell, int step) const;
};

/// A tripod can stand where the cell at the scanner's height is free and nothing is occupied
/// between the floor and the scanner within `clearance`; of such places, those in the largest area
/// that hangs together, so that what was seen through a window is left out. Throws Error when there
/// is none.
StandArea find_standpoints(const OccupancyMap& map,
                           const Floor& floor,
                           const StandpointOptions& options = {});

}  // namespace facula
