// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/polar_scan.hpp>
#include <facula/acquire/core/scan_grid.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// Why a filter removed a point.
enum class Removal : std::uint8_t {
  kKept,
  kNotFinite,    ///< a coordinate is NaN or infinite
  kMixed,        ///< hangs between two surfaces, in the spot's shadow of a depth edge
  kRange,        ///< outside the gate of range or height
  kIncidence,    ///< the surface is seen too flat
  kStatistical,  ///< unusually far from its neighbours
  kRadius        ///< too few points around it
};
constexpr std::size_t kRemovals = 7;

/// The word for a reason in reports and --json.
const char* to_string(Removal reason);

/// What a filter did: a reason for every point of the cloud it judged.
struct FilterVerdict {
  std::vector<Removal> reason;                       ///< per point
  std::array<std::size_t, kRemovals> count_of = {};  ///< points per reason, kKept among them

  explicit FilterVerdict(std::size_t points = 0);

  /// Removes a point that is still kept; the first reason stays.
  void remove(std::size_t point, Removal why);

  std::size_t count(Removal why) const { return count_of[static_cast<std::size_t>(why)]; }
  std::size_t removed() const { return reason.size() - count(Removal::kKept); }

  /// Indices of the points that are kept, ascending.
  std::vector<std::size_t> kept() const;
};

/// Takes what `next` says about the points that `verdict` kept, in their order.
void add_verdict(FilterVerdict& verdict, const FilterVerdict& next);

/// Clears the cells of a scan whose points (of cloud_from_scan) a filter removed. Throws Error when
/// the verdict is not about this scan's points.
void clear_removed(PolarScan& scan, const FilterVerdict& verdict);

/// A cloud with the grid it was scanned in; the grid may be empty.
struct GriddedCloud {
  PointCloud cloud;
  ScanGrid grid;
};

/// Keeps what the verdict keeps.
void apply(GriddedCloud& scan, const FilterVerdict& verdict);

}  // namespace facula
