// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/packed_cells.hpp>
#include <facula/map/packed_colors.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace facula {

/// Where a scan of a map came from.
struct ScanRecord {
  std::string name;                ///< no other scan of the map has it
  RigidTransform world_from_scan;  ///< pose that its rays were cast from
  std::size_t points = 0;          ///< of the scan [1]
  CastOptions cast;                ///< how they were cast
};

/// A scan that can be taken out of its map again.
struct KeptScan {
  ScanRecord record;
  PackedCells cells;
  std::vector<PackedColors> colors = {};  ///< of the cells its rays ended in; empty without
};

/// What a change of the scans took.
struct Rebuild {
  std::size_t bricks = 0;  ///< bricks of 8 x 8 x 8 cells made anew; no other was touched [1]
  std::size_t blocks = 0;  ///< blocks of kept cells that were opened for it [1]
};

/// An occupancy map that keeps its scans, so that one can be taken out, or put elsewhere, without
/// casting the others again. The map is always the one that inserting the kept scans in their order
/// makes, bit for bit. Adding a scan costs what inserting and compressing it costs, however many
/// are kept.
class ScanMap {
 public:
  explicit ScanMap(const OccupancyOptions& options = {});

  /// A map and the scans that made it, as a file keeps them. Throws Error when two scans share a
  /// name, or were cast at another resolution.
  ScanMap(OccupancyMap map, std::vector<KeptScan> scans);

  /// Inserts a scan's cells, and colours where it has some, and keeps them. Throws Error when the
  /// name is taken, or the cells are of another resolution.
  void add(const ScanRecord& record,
           const ScanCells& cells,
           std::span<const ColorBrick> colors = {});

  /// Casts a cloud of the scan frame, with sensor origins, at its pose, and adds it.
  void add(const std::string& name, const PointCloud& cloud, const RigidTransform& world_from_scan);

  /// Takes a scan out. Throws Error when there is none of that name.
  Rebuild remove(std::string_view name);

  /// Puts other cells in the place of the scan of that name: cast from a new pose, or scanned anew.
  Rebuild replace(const ScanRecord& record,
                  const ScanCells& cells,
                  std::span<const ColorBrick> colors = {});

  /// The map alone and its scans; this is empty afterwards.
  std::pair<OccupancyMap, std::vector<KeptScan>> release() && {
    return {std::move(map_), std::move(scans_)};
  }

  const OccupancyMap& map() const { return map_; }
  std::span<const KeptScan> scans() const { return scans_; }  ///< in the order of their insertion
  std::size_t skipped_points() const;                         ///< over the kept scans [1]
  std::size_t scan_memory() const;                            ///< of the kept scans [bytes]

 private:
  std::size_t place_of(std::string_view name) const;
  void check(const ScanRecord& record) const;
  Rebuild rebuild(std::vector<std::uint64_t> codes);

  OccupancyMap map_;
  std::vector<KeptScan> scans_;
};

}  // namespace facula
