// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/map/occupancy_map.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace facula {

struct MapDiffOptions {
  int slack_cells = 1;        ///< what was as close as this, per axis, has not changed [1], 0 to 10
  std::size_t min_cells = 1;  ///< smaller clusters are left out [1]
  bool newly_seen = false;    ///< also what is occupied now and was unknown
  int num_threads = 0;        ///< 0 = all cores [1]

  /// Throws Error naming the field, its value and its bound.
  void check() const;
};

enum class ChangeKind {
  kAppeared,  ///< free before, occupied after
  kVanished,  ///< occupied before, free after
  kNewlySeen  ///< unknown before, occupied after
};

std::string to_string(ChangeKind kind);

/// Changed cells that hang together over faces, edges or corners.
struct ChangeCluster {
  ChangeKind kind = ChangeKind::kAppeared;
  std::size_t cells = 0;                             ///< [1]
  double volume = 0;                                 ///< of the cells [m^3]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< mean of the cells' middles [m]
  Eigen::Vector3d min = Eigen::Vector3d::Zero();     ///< corner of the box of the cells [m]
  Eigen::Vector3d max = Eigen::Vector3d::Zero();     ///< [m]
};

/// A changed cell.
struct ChangedCell {
  CellKey key{};
  std::size_t cluster = 0;  ///< place among the clusters
};

/// What differs between two maps, in the frame and the cells of the first.
struct MapDiff {
  double resolution = 0;                ///< edge of a cell [m]
  std::vector<ChangeCluster> clusters;  ///< the largest first
  std::vector<ChangedCell> cells;       ///< cluster by cluster
  std::size_t compared_cells = 0;       ///< known in both maps [1]
  std::size_t left_out_cells = 0;       ///< of clusters below min_cells [1]
};

/// Compares two maps. The second is resampled into the first's cells as merge_map() does, so a pose
/// that is no whole number of cells moves surfaces by up to half a cell; slack_cells of 1 takes
/// that (and as much noise of the pose) for no change: a cell that appeared counts only where no
/// cell within that many was occupied before, one that vanished only where none is occupied after.
/// What one of the maps does not know has not changed. Throws Error as merge_map() does.
MapDiff diff_maps(const OccupancyMap& before,
                  const OccupancyMap& after,
                  const RigidTransform& before_from_after = {},
                  const MapDiffOptions& options = {});

/// The middles of the changed cells, in the first map's frame: green appeared, red vanished, blue
/// newly seen.
PointCloud cloud_of_changes(const MapDiff& diff);

}  // namespace facula
