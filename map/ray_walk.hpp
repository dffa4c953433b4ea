// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/voxel_bricks.hpp>

#include <optional>

#include <Eigen/Core>

namespace facula {

/// The cubic cells that rays walk through.
struct VoxelGrid {
  double resolution = 0;  ///< edge of a cell [m]
  double max_range = 0;   ///< longer rays only clear up to here, 0 = no limit [m]

  /// The cell of a point [m]; none where the point is not finite or beyond the 65536 cells an axis
  /// has (32768 to either side of 0).
  std::optional<CellKey> cell_of(const Eigen::Vector3f& x) const;
};

/// Marks the cells that the ray from `origin` to `end` passes, without the one it ends in, and the
/// one it ends in; of a ray longer than max_range only the cells up to there, all as passed. False,
/// with nothing marked, where a point is not finite or outside the grid. Walk by Amanatides and Woo
/// (1987), with the roundings, ties and stop rule of OctoMap 1.9.7 (float direction, double
/// parameters advanced by addition), so that the same cells are met.
bool walk_ray(const VoxelGrid& grid,
              const Eigen::Vector3f& origin,
              const Eigen::Vector3f& end,
              VoxelBricks& cells);

}  // namespace facula
