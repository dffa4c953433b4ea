// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/clearance.hpp>
#include <facula/map/reachable_cells.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace facula {

/// Where a ball may be, and where to try. What it points to has to outlive the search.
struct PathTask {
  const Clearance* clearance = nullptr;
  const ReachableCells* reachable = nullptr;            ///< the ball is nowhere else
  const std::vector<CellKey>* on_short_ways = nullptr;  ///< tries are made here, if it is not empty
  Eigen::AlignedBox3d known;                            ///< places stay within [m]
  double radius = 0;                                    ///< of the ball: what is to be kept [m]
  std::optional<double> height = std::nullopt;          ///< of all places, where it is fixed [m]

  /// Between two places that are looked at the clearance may be less by half a step [m].
  double asked_radius() const { return radius + clearance->step() / 2; }
};

struct PathSearchOptions {
  std::uint32_t seed = 1;      ///< above 0
  std::size_t max_tries = 0;   ///< for the first path [1]
  std::size_t more_tries = 0;  ///< seek further paths until so many were made in all [1]
};

struct FoundPath {
  std::vector<Eigen::Vector3d> corners;  ///< of the shortest path; empty when none was found [m]
  std::size_t tries = 0;                 ///< random tries in all [1]
  std::size_t paths = 0;                 ///< found [1]
};

/// Paths by OMPL's RRT-Connect, shortened and smoothed, from the first to the second of two places
/// whose clearance is asked_radius(). Lines between corners keep the radius.
FoundPath search_path(const PathTask& task,
                      const std::array<Eigen::Vector3d, 2>& ends,
                      const PathSearchOptions& options);

}  // namespace facula
