// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/mesh/range_surface.hpp>
#include <facula/reconstruct/mesh/volumetric_merge.hpp>

#include <vector>

namespace facula {

/// The voxel and the truncation that a merge uses [m].
struct VolumetricScale {
  double voxel = 0;
  double truncation = 0;
};

/// What the options say; else the median over the scans of their sampling, and three voxels.
/// `steps` holds the sampling of every scan, 0 where it has no surface; it may be empty where the
/// options name a voxel. Throws Error when neither says how large a voxel is.
VolumetricScale volumetric_scale(const VolumetricOptions& options,
                                 const std::vector<double>& steps);

RangeSurfaceOptions range_surface_options(const VolumetricOptions& options);

}  // namespace facula
