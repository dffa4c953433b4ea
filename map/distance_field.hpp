// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_box.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct DistanceFieldOptions {
  std::optional<CellBox> box = std::nullopt;      ///< none: the map's known box
  UnknownCells unknown = UnknownCells::kFree;     ///< what cells without evidence count as
  double max_distance = 0;                        ///< larger ones are cut to this, 0 = no limit [m]
  std::size_t max_memory = std::size_t{4} << 30;  ///< refuse to need more while computing [bytes]
  int num_threads = 0;                            ///< 0 = all cores [1]

  /// Throws Error naming the field, its value and its bound.
  void check() const;
};

/// Signed Euclidean distances of all cells of a box, exact. A free cell has the distance from its
/// centre to the centre of the nearest obstacle; an obstacle has, below 0, that to the centre of
/// the nearest cell that is none: on either side of a flat wall the field is one cell and minus one
/// cell. What lies outside of the box does not count, so give a box with a margin where that
/// matters. Distances are +-infinity (or +-max_distance) where the box holds no cell of the other
/// kind.
class DistanceField {
 public:
  /// Throws Error when the map knows nothing and no box is given, and before allocating when the
  /// box needs more than max_memory or is longer than kLongestDiagonal cells.
  explicit DistanceField(const OccupancyMap& map, const DistanceFieldOptions& options = {});

  const CellBox& box() const { return box_; }
  double resolution() const { return resolution_; }  ///< [m]

  /// What no distance is above, in either direction: max_distance, or infinity [m].
  double limit() const { return limit_; }

  /// Distance of a cell [m]; NaN outside of the box, and where unknown stays unknown.
  double at(const CellKey& cell) const;

  /// Its square, in whole cells, with the distance's sign; none where at() is NaN or infinite or
  /// cut.
  std::optional<std::int32_t> squared_cells(const CellKey& cell) const;

  struct Sample {
    double distance = 0;                                 ///< [m]
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  ///< of the distance [1]
  };
  /// The field between the centres of cells, trilinear, and its slope there; at the box's border
  /// the outermost centres' values go on. None outside of the box and beside cells that stay
  /// unknown.
  std::optional<Sample> sample(const Eigen::Vector3d& x) const;

  std::size_t memory_usage() const;  ///< [bytes]

  /// What computing the field of a box takes at its peak [bytes].
  static std::size_t memory_needed(const CellBox& box);

 private:
  double distance(std::int32_t squared) const;
  void mark_unknown(const OccupancyMap& map, int num_threads);

  CellBox box_;
  double resolution_ = 0;
  double limit_ = 0;
  std::vector<std::int32_t> squared_;
};

}  // namespace facula
