// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/clearance.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace facula {
namespace {

/// Cells that the field needs: those of the map, one layer of unknown ones around them where these
/// are obstacles (the nearest unknown cell outside lies in it), of all heights or of a slab.
CellBox field_box(const MapQuery& query, const ClearanceOptions& options, double slab) {
  require(query.known().has_value(),
          "expected a map with at least one known cell, got an empty one; insert a scan first");
  const CellBox all = grown(*query.known(), options.unknown == UnknownCells::kOccupied ? 1 : 0);
  if (!options.height) return all;
  const double cell = query.resolution();
  CellBox flat = all;
  const auto key = [&](double z) {
    const double index = std::floor(z / cell) + kCentreKey;
    return static_cast<int>(std::clamp<double>(index, 0, kKeyLimit - 1));
  };
  flat.low[2] = key(*options.height - slab);
  flat.high[2] = key(*options.height + slab);
  const auto common = common_cells(all, flat);
  require(common.has_value(),
          "expected a height within the map, got ",
          *options.height,
          " m; see the map's corners with 'facula info'");
  return *common;
}

}  // namespace

Clearance::Clearance(const OccupancyMap& map, const ClearanceOptions& options)
    : unknown_(options.unknown),
      query_(map, options.num_threads),
      slab_(options.height ? options.reach + 2 * map.resolution()
                           : std::numeric_limits<double>::infinity()),
      field_(map,
             {.box = field_box(query_, options, slab_),
              .unknown = options.unknown,
              .max_distance = options.reach + 2 * map.resolution(),
              .max_memory = options.max_memory,
              .num_threads = options.num_threads}) {}

double Clearance::exact(const Eigen::Vector3d& x, double most) const {
  const auto nearest = query_.nearest_obstacle(x, most, unknown_);
  return nearest ? nearest->distance : most;
}

Clearance::Bounds Clearance::bounds(const CellKey& cell) const {
  const double distance = field_.at(cell);
  if (std::isnan(distance)) return {};
  // From x to its cell's centre, and from an obstacle's centre to its corners, it is at most half a
  // diagonal; an obstacle's surface is nearer than its centre by half an edge or more.
  const double half_edge = query_.resolution() / 2;
  const double half_diagonal = half_edge * std::numbers::sqrt3;
  Bounds result{.low = std::min(distance - 2 * half_diagonal, slab_ - 2 * half_edge)};
  if (distance < field_.limit()) result.high = distance + half_diagonal - half_edge;
  return result;
}

double Clearance::at_least(const Eigen::Vector3d& x) const {
  const auto cell = cell_of(x, query_.resolution());
  return cell ? bounds(*cell).low : 0;
}

bool Clearance::may_hold(const CellKey& cell, double radius) const {
  return bounds(cell).high >= radius;
}

bool Clearance::holds_at_centre(const CellKey& cell, double radius) const {
  const double half_diagonal = query_.resolution() / 2 * std::numbers::sqrt3;
  return std::min(field_.at(cell), slab_) - half_diagonal >= radius;
}

bool Clearance::holds(const Eigen::Vector3d& x, double radius) const {
  const auto cell = cell_of(x, query_.resolution());
  const Bounds known = cell ? bounds(*cell) : Bounds();
  if (known.low >= radius) return true;
  if (known.high < radius) return false;
  const auto nearest = query_.nearest_obstacle(x, radius, unknown_);
  return !nearest || nearest->distance >= radius;
}

bool Clearance::holds_along(const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b,
                            double radius) const {
  const double length = (b - a).norm();
  for (double at = 0; at < length;) {
    const Eigen::Vector3d x = a + (at / length) * (b - a);
    // As far as the clearance is above the radius, no step can lead below it.
    const double spare = at_least(x) - radius;
    if (spare < step() && !holds(x, radius)) return false;
    at += std::max(spare, step());
  }
  return holds(b, radius);
}

}  // namespace facula
