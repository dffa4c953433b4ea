// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/map/cell_grid.hpp>
#include <facula/map/cell_mask.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace facula {

/// A box whose faces belong to it [m].
struct MapBox {
  Eigen::Vector3f min = Eigen::Vector3f::Zero();
  Eigen::Vector3f max = Eigen::Vector3f::Zero();
};

/// How rays become cells: the meaning of each is OctoMap 1.9.7's.
struct CastOptions {
  double resolution = 0.05;  ///< edge of a cell [m], above 0
  double max_range = 0;      ///< longer rays only clear up to here, 0 = no limit [m]
  bool discretize = false;   ///< one ray per cell that points lie in, to its middle
  bool weigh_sigma = false;  ///< hits of points that are not sure of their cell count less
  std::optional<MapBox> box =
      std::nullopt;     ///< only rays that end in it count, from their end back to its border
  int num_threads = 0;  ///< 0 = all cores [1]
};

/// Cells of one brick that a scan met; no cell is in both sets.
struct ScanBrick {
  static constexpr std::uint8_t kSure = 8;

  std::uint64_t code = 0;        ///< brick_code()
  CellMask passed;               ///< a ray went through, none ended
  CellMask ended;                ///< a ray ended
  std::uint8_t eighths = kSure;  ///< what a hit counts, 1 to 8; 8 unless sigmas are weighed [1]

  friend bool operator==(const ScanBrick&, const ScanBrick&) = default;
};

/// All that one scan says about space.
struct ScanCells {
  std::vector<ScanBrick> bricks;  ///< by ascending code, those of one code by falling eighths
  std::size_t skipped = 0;        ///< points that are not finite or outside the 65536 cells [1]
};

/// The cells that the rays from every point's sensor origin to the point meet; both in the map's
/// frame. However many rays meet a cell it is in one set once: in `ended` if any ray ended there.
/// For one origin these are the sets of OcTree::computeUpdate() (with box and range) or
/// computeDiscreteUpdate(). The result does not depend on the order of points, nor on the threads.
/// Throws Error when points have no sensor origins.
ScanCells cells_of_scan(const PointCloud& cloud, const CastOptions& options);

/// The same, one ray after the other and without tricks: what cells_of_scan() is held against.
ScanCells cells_of_scan_reference(const PointCloud& cloud, const CastOptions& options);

}  // namespace facula
