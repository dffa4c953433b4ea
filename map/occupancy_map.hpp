// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/map/cell_colors.hpp>
#include <facula/map/log_odds_map.hpp>
#include <facula/map/scan_cells.hpp>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>

#include <Eigen/Core>

namespace facula {

/// The log-odds model of OctoMap (Hornung et al. 2013), with its defaults.
struct OccupancyOptions {
  double resolution = 0.05;   ///< edge of a cell [m], above 0
  double max_range = 0;       ///< longer rays only clear up to here, 0 = no limit [m]
  double hit = 0.7;           ///< probability of a cell that a ray ends in [1], 0.5 to 1
  double miss = 0.4;          ///< of a cell that a ray passes [1], 0 to 0.5
  double clamp_min = 0.1192;  ///< least probability a cell can reach [1], 0 to 0.5
  double clamp_max = 0.971;   ///< largest [1], 0.5 to 1
  bool discretize = false;    ///< one ray per cell that points lie in, to its middle
  bool weigh_sigma = false;   ///< points unsure of their cell hit it less; OctoMap does not
  std::optional<MapBox> box = std::nullopt;  ///< only rays that end in it count
  int num_threads = 0;                       ///< 0 = all cores [1]

  /// Throws Error naming the field, its value and its bound.
  void check() const;
  LogOddsModel model() const;
  CastOptions cast() const;
};

enum class CellState { kUnknown, kFree, kOccupied };

struct MapStatistics {
  std::size_t free_cells = 0;                     ///< at the finest level [1]
  std::size_t occupied_cells = 0;                 ///< at the finest level [1]
  std::size_t nodes = 0;                          ///< of OctoMap's tree, pruned [1]
  std::size_t memory = 0;                         ///< [bytes]
  Eigen::Vector3d min = Eigen::Vector3d::Zero();  ///< of the known volume [m]
  Eigen::Vector3d max = Eigen::Vector3d::Zero();  ///< [m]
};

/// Which cells of space are free, occupied or unknown. The map that OctoMap 1.9.7 makes of the same
/// rays, cell by cell and to the last bit, kept as bricks of 8 x 8 x 8 cells instead of a tree.
class OccupancyMap {
 public:
  explicit OccupancyMap(const OccupancyOptions& options = {});

  /// Casts a ray from every point's sensor origin to the point; both in the map's frame. One call
  /// is one scan: however many rays meet a cell, it gets one hit where a ray ended in it, else one
  /// miss where a ray passed, as in OcTree::insertPointCloud(); for a cloud with a single origin
  /// the map is the same, byte for byte. The columns of a turning head have their own origins but
  /// are not scans of their own: neighbouring columns see the same cells, would count the same
  /// evidence many times over, and a column that grazes a thin surface would take away what its
  /// neighbour has just put there. So insert one scan per call. Points that are not finite, or
  /// (they or their origin) farther than 32768 cells from 0, are skipped and counted. Throws Error
  /// when points have no sensor origins.
  void insert(const PointCloud& cloud);

  /// The same for a scan that was cast before, at this map's resolution.
  void insert(const ScanCells& scan);

  std::size_t skipped_points() const { return skipped_; }    ///< over all calls of insert() [1]
  double resolution() const { return options_.resolution; }  ///< [m]
  const OccupancyOptions& options() const { return options_; }

  /// Unknown where x is not finite or outside the 65536 cells of an axis.
  CellState state(const Eigen::Vector3d& x) const;
  CellState state_of_cell(const CellKey& cell) const;

  /// None where the cell is unknown.
  std::optional<float> log_odds(const Eigen::Vector3d& x) const;

  MapStatistics statistics() const;

  /// Calls visit(centre, state, edge length [m]) for every leaf of OctoMap's tree of this map.
  void for_each_leaf(
      const std::function<void(const Eigen::Vector3d&, CellState, double)>& visit) const;

  /// The known cells of a brick of 8 x 8 x 8.
  struct BrickView {
    CellKey first;   ///< its lowest cell
    CellMask known;  ///< free or occupied
    CellMask occupied;
  };
  /// Calls visit for every brick with a known cell, in Morton order.
  void for_each_brick(const std::function<void(const BrickView&)>& visit) const;

  /// Writes .ot (probabilities; with colours a ColorOcTree), .bt (free or occupied) or .fmap
  /// (map_file.hpp), whole or not at all.
  void write(const std::filesystem::path& path) const;

  /// Reads .ot, .bt, .fmap or the index of a map in blocks (map_folder.hpp), whichever the file's
  /// first line says. Options other than the resolution are the defaults, but for the latter two,
  /// which have them. Throws Error when the file is missing, torn, or none of these.
  static OccupancyMap read(const std::filesystem::path& path);

  LogOddsMap& bricks() { return bricks_; }
  const LogOddsMap& bricks() const { return bricks_; }

  /// Colours of cells; empty where no cloud that was inserted had colours.
  CellColors& colors() { return colors_; }
  const CellColors& colors() const { return colors_; }

 private:
  OccupancyOptions options_;
  LogOddsMap bricks_;
  CellColors colors_;
  std::size_t skipped_ = 0;
};

}  // namespace facula
