// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/coarse_map.hpp>

#include <vector>

namespace facula {

/// Frontier cells that lie together.
struct FrontierRegion {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< middle of the cell nearest its mean [m]
  std::size_t cells = 0;                             ///< [1]
  double area = 0;                                   ///< cells times the area of a face [m^2]
};

/// Where the known free space ends.
struct FrontierRegions {
  static constexpr int kNone = -1;
  std::vector<FrontierRegion> regions;
  std::vector<int> region_of;  ///< of every cell of the map, kNone for those that are no frontier
  std::size_t cells = 0;       ///< frontier cells altogether [1]
};

/// Free cells with an unknown one at a face, in regions of cells that touch (by face, edge or
/// corner); regions longer than `longest` [m] along an axis are halved until they are not.
FrontierRegions frontier_regions(const CoarseMap& map, double longest);

}  // namespace facula
