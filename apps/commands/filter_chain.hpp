// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>
#include <facula/reconstruct/filter/filter_verdict.hpp>
#include <facula/reconstruct/filter/gate_filters.hpp>
#include <facula/reconstruct/filter/outlier_filters.hpp>
#include <facula/reconstruct/filter/scan_filters.hpp>

#include <optional>

namespace facula {

/// Which filters run, in this order, each on what the ones before it kept.
struct FilterChain {
  bool mixed = true;  ///< where there is a grid of a scanner's columns
  MixedPointOptions mixed_options;
  std::optional<RangeGate> range;
  std::optional<HeightGate> height;
  RigidTransform world_from_scan;       ///< where heights are measured
  std::optional<double> max_incidence;  ///< [rad]
  std::optional<StatisticalFilterOptions> statistical;
  std::optional<RadiusFilterOptions> radius;
  int num_threads = 0;
};

/// Runs the chain over the points of a scan or a cloud; `scan` is null where there is no polar
/// scan, else its points are those of the cloud. Afterwards `points` holds what is kept.
FilterVerdict run_filters(GriddedCloud& points, const PolarScan* scan, const FilterChain& chain);

}  // namespace facula
