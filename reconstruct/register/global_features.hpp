// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/register/feature_matches.hpp>
#include <facula/reconstruct/register/nearest_grid.hpp>
#include <facula/reconstruct/register/scan_pyramid.hpp>
#include <facula/reconstruct/register/scan_view.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace facula {

struct GlobalFeatureOptions {
  double voxel = 0;     ///< distance of the points that carry features [m]; 0 = feature_voxel()
  bool planes = true;   ///< look for planes too
  int num_threads = 0;  ///< 0 = all cores [1]

  void check() const;
};

/// A scan made ready for registration without a guess, once for all the pairs it takes part in.
struct GlobalFeatures {
  const ScanPyramid* scan = nullptr;        ///< not owned: must outlive this
  double voxel = 0;                         ///< [m]
  PointCloud cloud;                         ///< the scan thinned to the voxel, with unit normals
  NearestGrid near;                         ///< over the cloud; reaches three voxels
  std::vector<FpfhFeature> features;        ///< of the cloud's points
  std::shared_ptr<const FeatureTree> tree;  ///< over the features
  std::vector<Plane> planes;  ///< of a room, largest first, normals to the side that was seen
  ScanView view;              ///< in the scan's frame
};

/// A voxel that leaves each of the scans some two thousand points or fewer [m]. Scans that are to
/// be registered with each other need features of one voxel.
double feature_voxel(const std::vector<const ScanPyramid*>& scans);

/// Throws Error naming the scan when fewer than 12 points with normals are left at the voxel.
GlobalFeatures find_global_features(const ScanPyramid& scan,
                                    const GlobalFeatureOptions& options = {});

}  // namespace facula
