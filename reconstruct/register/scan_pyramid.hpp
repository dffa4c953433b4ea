// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace facula {

struct PyramidOptions {
  double finest_voxel = 0;     ///< of level 0 [m]; 0 = from the sampling distance of the scan
  int levels = 3;              ///< each twice as coarse as the one before [1], 1 to 8
  int normal_neighbours = 20;  ///< where the scan brings no normals of its own [1], at least 3
  int num_threads = 0;         ///< 0 = all cores [1]

  void check() const;
};

/// One level: the scan thinned to a voxel, in its own frame, with unit normals and a search tree.
struct PyramidLevel {
  double voxel = 0;  ///< [m]
  PointCloud cloud;  ///< with normals; sigma and sensor origins where the scan has them
  NearestNeighbours tree;
  std::vector<float> merged;  ///< scan points that each point is the mean of [1]
};

/// A scan made ready for registration, once for all the pairs it takes part in.
struct ScanPyramid {
  std::string name;
  bool oriented = false;             ///< normals point to the side the scanner saw
  double diameter = 0;               ///< diagonal of the points' bounding box [m]
  std::vector<PyramidLevel> levels;  ///< finest first
};

/// Normals are the scan's own, or its grid's, or those of neighbours. Throws Error naming the scan
/// when fewer than 12 finite points or no surface are left.
ScanPyramid build_pyramid(const PosedCloud& scan, const PyramidOptions& options = {});

/// The mean of a cloud's points, which must be finite; at least one [m].
Eigen::Vector3d middle_of(const PointCloud& cloud);

/// The coarsest level with at least so many points, or the finest. Throws Error when there is none.
const PyramidLevel& coarsest_level(const ScanPyramid& scan, std::size_t least_points);

}  // namespace facula
