// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>

#include <Eigen/Core>

namespace octomap {
class OcTree;
}

namespace facula {

/// The log-odds model of OctoMap (Hornung et al. 2013).
struct OccupancyOptions {
  double resolution = 0.05;   ///< edge of a cell [m], above 0
  double max_range = 0;       ///< longer rays only clear up to here, 0 = no limit [m]
  double hit = 0.7;           ///< probability of a cell that a ray ends in [1], 0.5 to 1
  double miss = 0.4;          ///< of a cell that a ray passes [1], 0 to 0.5
  double clamp_min = 0.1192;  ///< least probability a cell can reach [1], 0 to 0.5
  double clamp_max = 0.971;   ///< largest [1], 0.5 to 1
  int num_threads = 0;        ///< 0 = all cores [1]

  /// Throws Error naming the field, its value and its bound.
  void check() const;
};

enum class CellState { kUnknown, kFree, kOccupied };

struct MapStatistics {
  std::size_t free_cells = 0;                     ///< at the finest level [1]
  std::size_t occupied_cells = 0;                 ///< at the finest level [1]
  std::size_t nodes = 0;                          ///< of the tree [1]
  Eigen::Vector3d min = Eigen::Vector3d::Zero();  ///< of the known volume [m]
  Eigen::Vector3d max = Eigen::Vector3d::Zero();  ///< [m]
};

/// Which cells of space are free, occupied or unknown: an OctoMap behind a thin door.
class OccupancyMap {
 public:
  explicit OccupancyMap(const OccupancyOptions& options = {});
  ~OccupancyMap();
  OccupancyMap(OccupancyMap&&) noexcept;
  OccupancyMap& operator=(OccupancyMap&&) noexcept;

  /// Casts a ray from every point's sensor origin to the point; both in the map's frame. One call
  /// is one scan: however many rays meet a cell, it gets one hit where a ray ended in it, else one
  /// miss where a ray passed, as in OcTree::insertPointCloud(); for a cloud with a single origin
  /// the tree is the same, byte for byte. The columns of a turning head have their own origins but
  /// are not scans of their own: neighbouring columns see the same cells, would count the same
  /// evidence many times over, and a column that grazes a thin surface would take away what its
  /// neighbour has just put there. So insert one scan per call. Points that are not finite, or
  /// (they or their origin) farther than 32768 cells from 0, are skipped and counted. Throws Error
  /// when points have no sensor origins.
  void insert(const PointCloud& cloud);

  std::size_t skipped_points() const;  ///< over all calls of insert() [1]
  double resolution() const;           ///< [m]

  /// Unknown where x is not finite or outside the tree.
  CellState state(const Eigen::Vector3d& x) const;
  MapStatistics statistics() const;

  /// Calls visit(centre, state, edge length [m]) for every leaf.
  void for_each_leaf(
      const std::function<void(const Eigen::Vector3d&, CellState, double)>& visit) const;

  /// Writes .ot (probabilities) or .bt (free or occupied), whole or not at all; .bt does not change
  /// this map.
  void write(const std::filesystem::path& path) const;

  /// Reads .ot or .bt, whichever the file's first line says. Options other than the resolution are
  /// the defaults. Throws Error when the file is missing, torn, or not an OcTree.
  static OccupancyMap read(const std::filesystem::path& path);

  /// A map with this tree's cells, resolution and sensor model.
  static OccupancyMap from_octree(const octomap::OcTree& tree);

  const octomap::OcTree& octree() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace facula
