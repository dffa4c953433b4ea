// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_box.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct PathPlanOptions {
  double radius = 0.25;  ///< of the ball that has to stay clear of obstacles [m], above 0
  UnknownCells unknown = UnknownCells::kOccupied;  ///< kOccupied: unknown cells block; kFree: not
  bool flat = false;               ///< stay at the start's height, for robots on the ground
  std::uint32_t seed = 1;          ///< of the random tries, above 0
  std::size_t max_tries = 100000;  ///< give up after so many random tries [1]
  std::size_t more_tries = 2000;   ///< seek further paths until so many were made in all [1]
  double max_clearance = 2;        ///< larger clearances are given as this [m], above 0
  /// Of the distance field; the search may take half as much again [bytes].
  std::size_t max_memory = std::size_t{4} << 30;
  int num_threads = 0;  ///< 0 = all cores [1]

  /// Throws Error naming the field, its value and its bound.
  void check() const;
};

/// A place on a path, in the map's frame.
struct PathSample {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();  ///< [m]
  double clearance = 0;  ///< to the nearest point of an obstacle's cell, at most max_clearance [m]
};

struct PathPlan {
  std::vector<Eigen::Vector3d> corners;  ///< straight lines between them are the path [m]
  std::vector<PathSample> samples;       ///< along it, at most half a cell apart, ends included
  double length = 0;                     ///< [m]
  double least_clearance = 0;            ///< over the samples [m]
  std::size_t tries = 0;                 ///< random tries in all [1]
  std::size_t paths = 0;                 ///< found; this is the shortest of them [1]
};

/// A short path for a ball from one place to another, in the map's frame: found by RRT-Connect
/// (Kuffner and LaValle 2000) of OMPL over the cells that the ball can reach, then shortened and
/// smoothed; the shortest of several where they come easily. The whole path, not only its samples,
/// keeps `radius` from obstacles; every sample is checked once more against the map's cells. Places
/// stay within the map's known box. The same path for the same seed and any number of threads:
/// tries are counted, not seconds. OMPL has one source of seeds for the whole process, so plans are
/// made one after the other, and other users of OMPL in the process get seeds from where a plan
/// left off. Throws Error when a place lies outside of the known box or nearer to obstacles than
/// the radius (with its clearance), when `flat` and the heights differ, when there is no path, and
/// when none was found.
PathPlan plan_path(const OccupancyMap& map,
                   const Eigen::Vector3d& from,
                   const Eigen::Vector3d& to,
                   const PathPlanOptions& options = {});

}  // namespace facula
