// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_box.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct RayQueryOptions {
  double max_range = 0;  ///< from the origin to a cell's centre, 0 = no limit [m]
  UnknownCells unknown =
      UnknownCells::kOccupied;  ///< kFree: rays pass them; others: they end there

  /// Throws Error naming the field, its value and its bound.
  void check() const;
};

/// Where a ray ended.
struct RayHit {
  enum class End {
    kOccupied,  ///< in an occupied cell
    kUnknown,   ///< in an unknown cell, where those do not let rays pass
    kNothing    ///< beyond max_range, or where nothing is known any more
  };
  End end = End::kNothing;
  CellKey cell{};                                   ///< the last one that was looked at
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< where the ray enters it [m]
  double distance = 0;                              ///< of this point from the origin [m]
};

struct CellCounts {
  std::size_t free = 0;      ///< [1]
  std::size_t occupied = 0;  ///< [1]
  std::size_t unknown = 0;   ///< [1]
};

/// An obstacle near a point.
struct NearCell {
  CellKey cell{};
  double distance = 0;  ///< from the point to the nearest point of the cell, 0 within it [m]
};

/// Answers questions about a map quickly: a table of its bricks, each as two sets of bits. Answers
/// for what the map was when this was made; holds no reference to it.
class MapQuery {
 public:
  explicit MapQuery(const OccupancyMap& map, int num_threads = 0);

  double resolution() const { return resolution_; }               ///< [m]
  const std::optional<CellBox>& known() const { return known_; }  ///< none: nothing is known

  /// As OccupancyMap::state(), and as OcTree::search() finds it.
  CellState state(const Eigen::Vector3d& x) const;
  CellState state_of_cell(const CellKey& cell) const;

  /// The states of many points, in their order.
  std::vector<CellState> states(std::span<const Eigen::Vector3d> points, int num_threads = 0) const;

  /// Follows a ray to the first cell that does not let it pass; the direction may have any length
  /// but 0. The cell is that of OcTree::castRay() of OctoMap 1.9.7 (Amanatides and Woo 1987) for
  /// the same floats; kUnknown ends are those for which castRay() says false. Throws Error when the
  /// origin or direction is not finite, the direction is 0, or the origin lies outside of the 65536
  /// cells of an axis.
  RayHit cast_ray(const Eigen::Vector3f& origin,
                  const Eigen::Vector3f& direction,
                  const RayQueryOptions& options = {}) const;

  /// How many cells of a box are free, occupied, unknown.
  CellCounts count(const CellBox& box) const;
  bool any_occupied(const CellBox& box) const;

  /// The obstacle nearest to x among those that a ball about x of this radius [m] reaches into or
  /// touches; none when there is none. With kOccupied unknown cells are obstacles too. Among
  /// equally near ones the one with the least key (z, then y, then x).
  std::optional<NearCell> nearest_obstacle(const Eigen::Vector3d& x,
                                           double radius,
                                           UnknownCells unknown = UnknownCells::kFree) const;

  std::size_t memory_usage() const;  ///< [bytes]

 private:
  struct Brick {
    CellMask known;
    CellMask occupied;
  };

  const Brick& find(const CellKey& cell) const;
  std::optional<NearCell> nearest_within(const Eigen::Vector3d& x,
                                         double radius,
                                         UnknownCells unknown) const;

  double resolution_;
  std::optional<CellBox> known_;
  std::vector<Brick> bricks_;  // the first one stands for all where nothing is known
  // Places of bricks, 0 for none: over the box of all bricks (behind a first 0 for what lies
  // outside of it) where that is small enough, else by their codes.
  CellBox table_box_;  // in bricks
  std::vector<std::uint32_t> table_;
  BrickIndex index_;
};

}  // namespace facula
