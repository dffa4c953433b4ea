// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/map/occupancy_map.hpp>

#include <cstddef>

namespace facula {

/// What a merge did.
struct MapMerge {
  bool exact = false;            ///< every cell of the source has exactly one cell of the target
  std::size_t new_cells = 0;     ///< known in the source only [1]
  std::size_t joined_cells = 0;  ///< known in both: log-odds were added [1]
};

/// Adds the evidence of another map. Each cell of the target whose middle falls into a known cell
/// of the source takes that cell's log-odds: they are added to its own, unknown counting as 0, and
/// the sum is held between the target's clamps. Where cells are as large in both maps and the pose
/// is a whole number of cells, turned by right angles at most, this is the exact sum, cell by cell;
/// otherwise cells are resampled: a source cell then speaks for as many target cells as have their
/// middle in it, which may be none or two beside each other, and surfaces move by up to half a
/// cell. Colours go to the target cell that their cell's middle falls into. Clamps keep no evidence
/// beyond them, so a merge is not the map of all scans together (keep the scans, scan_map.hpp, for
/// that). Target cells outside the 65536 cells of an axis are left out. The same for any number of
/// threads. Throws Error for a pose that is not finite, and where the source would fill more than
/// 2^25 bricks of 8 x 8 x 8 target cells.
MapMerge merge_map(OccupancyMap& target,
                   const OccupancyMap& source,
                   const RigidTransform& target_from_source = {});

}  // namespace facula
