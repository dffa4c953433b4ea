// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/map_query.hpp>
#include <facula/map/place_text.hpp>
#include <facula/map/ray_walk.hpp>

#include <array>
#include <cmath>

namespace facula {
namespace {

/// The walk of OctoMap's castRay(): AxisWalk's, but half a cell is added in double.
class CastWalk {
 public:
  CastWalk(const Eigen::Vector3f& origin,
           const Eigen::Vector3f& direction,
           const CellKey& first,
           double resolution)
      : key_(first) {
    // As OctoMap normalises: length in double, division in float.
    const auto length = static_cast<float>(ray_length(direction));
    const Eigen::Vector3f unit = direction / length;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      axes_[i] = AxisWalk::start(resolution, first[i], origin[axis], unit[axis]);
      if (axes_[i].step == 0) continue;
      double border = (static_cast<double>(first[i] - kCentreKey) + 0.5) * resolution;
      border += axes_[i].step * resolution * 0.5;
      axes_[i].next =
          (border - static_cast<double>(origin[axis])) / static_cast<double>(unit[axis]);
    }
  }

  const CellKey& key() const { return key_; }
  double entered() const { return entered_; }  ///< ray parameter where it came into the cell [m]

  /// False when there are no cells ahead.
  bool advance() {
    const auto& [x, y, z] = axes_;
    const std::size_t nearer = x.next < y.next ? 0 : 1;
    const std::size_t axis = axes_[nearer].next < z.next ? nearer : 2;
    const int next = key_[axis] + axes_[axis].step;
    if (next < 0 || next >= kKeyLimit) return false;
    key_[axis] = next;
    entered_ = axes_[axis].next;
    axes_[axis].next += axes_[axis].delta;
    return true;
  }

  /// Whether the walk is outside of the box and will not come into it any more.
  bool left(const CellBox& box) const {
    for (std::size_t i = 0; i < 3; ++i) {
      if (key_[i] < box.low[i] && axes_[i].step <= 0) return true;
      if (key_[i] > box.high[i] && axes_[i].step >= 0) return true;
    }
    return false;
  }

 private:
  CellKey key_;
  std::array<AxisWalk, 3> axes_;
  double entered_ = 0;
};

/// Squared distance from the origin to a cell's centre, in float as OctoMap has it.
double centre_distance_squared(const CellKey& cell,
                               const Eigen::Vector3f& origin,
                               double resolution) {
  const Eigen::Vector3f away = centre_of(cell, resolution).cast<float>() - origin;
  double squared = 0;
  for (Eigen::Index i = 0; i < 3; ++i) squared += static_cast<double>(away[i] * away[i]);
  return squared;
}

void require_ray(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) {
  // Lengths whose square is no float any more have no direction either.
  const double length = ray_length(direction);
  if (origin.allFinite() && std::isfinite(length) && length > 0) return;
  fail("expected a ray with a finite origin and a direction that is not 0 or beyond 1e19 m, got ",
       place_text(origin),
       " m and ",
       place_text(direction));
}

}  // namespace

void RayQueryOptions::check() const {
  require(std::isfinite(max_range) && max_range >= 0,
          "RayQueryOptions: expected max_range of 0 m (no limit) or more, got ",
          max_range);
}

RayHit MapQuery::cast_ray(const Eigen::Vector3f& origin,
                          const Eigen::Vector3f& direction,
                          const RayQueryOptions& options) const {
  options.check();
  require_ray(origin, direction);
  const auto first = cell_of(origin.cast<double>(), resolution_);
  if (!first) {
    fail("expected a ray's origin within ",
         kCentreKey,
         " cells of the map's origin, got ",
         place_text(origin),
         " m");
  }
  const bool passes_unknown = options.unknown == UnknownCells::kFree;
  CastWalk walk(origin, direction, *first, resolution_);
  const auto hit = [&](RayHit::End end) {
    const Eigen::Vector3d unit = direction.cast<double>().normalized();
    return RayHit{end, walk.key(), origin.cast<double>() + walk.entered() * unit, walk.entered()};
  };
  for (bool begins = true;; begins = false) {
    const double limit = options.max_range;
    if (!begins && limit > 0 &&
        centre_distance_squared(walk.key(), origin, resolution_) > limit * limit) {
      return hit(RayHit::End::kNothing);
    }
    const CellState state = state_of_cell(walk.key());
    if (state == CellState::kOccupied) return hit(RayHit::End::kOccupied);
    if (state == CellState::kUnknown && !passes_unknown) return hit(RayHit::End::kUnknown);
    if (!known_ || walk.left(*known_)) return hit(RayHit::End::kNothing);
    if (!walk.advance()) return hit(RayHit::End::kNothing);
  }
}

}  // namespace facula
