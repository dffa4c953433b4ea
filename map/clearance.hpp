// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/distance_field.hpp>
#include <facula/map/map_query.hpp>

#include <cstddef>
#include <limits>
#include <optional>

#include <Eigen/Core>

namespace facula {

struct ClearanceOptions {
  UnknownCells unknown = UnknownCells::kOccupied;  ///< kOccupied blocks, others are free
  /// Only questions at this height will be asked: the field then covers a slab about it [m].
  std::optional<double> height = std::nullopt;
  double reach = 1;  ///< clearances up to here are told quickly [m], above 0
  std::size_t max_memory = std::size_t{4} << 30;  ///< of the distance field [bytes]
  int num_threads = 0;                            ///< 0 = all cores [1]
};

/// How far points are from the nearest obstacle: from its cell's nearest point, not its centre. The
/// distance field gives bounds in a glance; where these do not decide, the map's cells do.
class Clearance {
 public:
  /// Throws Error where DistanceField does.
  Clearance(const OccupancyMap& map, const ClearanceOptions& options);

  /// Exact, up to `most` [m]; larger ones are given as `most`.
  double exact(const Eigen::Vector3d& x, double most) const;

  /// A number that the clearance is not below, found without a search; may be below 0.
  double at_least(const Eigen::Vector3d& x) const;

  /// False where no place in the cell has a clearance of `radius` [m]; a glance at the field.
  bool may_hold(const CellKey& cell, double radius) const;

  /// True only where a cell's centre has a clearance of `radius` [m]; a glance as well.
  bool holds_at_centre(const CellKey& cell, double radius) const;

  /// Whether the clearance is `radius` [m] or more.
  bool holds(const Eigen::Vector3d& x, double radius) const;

  /// Whether it is so all along the line from a to b, ends included. Where obstacles are near, the
  /// line is looked at in steps of step() [m], so that between them it may be less by half a step.
  bool holds_along(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius) const;

  double step() const { return query_.resolution() / 8; }  ///< [m]
  const MapQuery& query() const { return query_; }

 private:
  struct Bounds {
    double low = 0;
    double high = std::numeric_limits<double>::infinity();
  };
  /// Of all places in a cell.
  Bounds bounds(const CellKey& cell) const;

  UnknownCells unknown_;
  MapQuery query_;
  double slab_ =
      std::numeric_limits<double>::infinity();  // the field reaches so far up and down [m]
  DistanceField field_;
};

}  // namespace facula
