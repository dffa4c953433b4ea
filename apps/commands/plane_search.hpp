// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/cli/session.hpp>
#include <facula/reconstruct/measure/plane_relations.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// What the commands that measure planes are told alike, so that plane 2 is the same plane in all
/// of them.
struct PlaneSearch {
  std::vector<std::filesystem::path> scans;
  std::filesystem::path csv;
  PlaneExtractionOptions options;
  std::string method = "auto";
  std::size_t seed = 1;
  double voxel = 0;             ///< 0 = all points [m]
  double tilt_zero = 0;         ///< added to the tilts of range, pan and tilt lists [rad]
  std::string sweeps = "both";  ///< of range, pan and tilt lists: or rising, or falling
  RelationOptions relations;
};

struct FoundPlanes {
  PointCloud cloud;
  std::vector<ExtractedPlane> planes;  ///< largest first; plane 1 is the first
  double inlier_distance = 0;          ///< they were found with [m]
  bool widened = false;                ///< by the sigma of points that know theirs
};

void declare_plane_search(Arguments& arguments, PlaneSearch& search);

/// The option by which errors that all ranges share are told.
void declare_shared_range(Arguments& arguments, PlaneSearch& search);

/// Reads the scans, finds their planes and reports how many points and planes there are. Throws
/// Error when there is no plane.
FoundPlanes find_planes(const PlaneSearch& search, Session& session);

/// The same of scans that are read, as find_planes() finds them with the same options; there may be
/// none.
FoundPlanes planes_of(const ScanProject& project, PlaneExtractionOptions options);

/// The plane that a person calls `number`, 1 the largest. Throws Error when there is none.
const ExtractedPlane& plane_called(const std::vector<ExtractedPlane>& planes, std::size_t number);

/// Pairs of planes to compare: (datum, other). All of them, the larger one the datum; or those of
/// the plane called `reference` with each other one.
std::vector<std::pair<std::size_t, std::size_t>> plane_pairs(
    const std::vector<ExtractedPlane>& planes, std::size_t reference);

}  // namespace facula
