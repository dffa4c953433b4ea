// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/reconstruct/mesh/volumetric_merge.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace facula {

enum class MeshMethod : std::uint8_t {
  kVolumetric,      ///< merge_volumetric(): lines of sight and sigma of every scan
  kPoisson,         ///< mesh_poisson(): closed, from normals
  kAdvancingFront,  ///< mesh_advancing_front(): through all points
  kScaleSpace,      ///< mesh_scale_space(): through noisy points without normals
  kAlphaWrap        ///< wrap_points(): closed, around the points
};

std::string to_string(MeshMethod method);

/// The method of that name; throws Error naming them all.
MeshMethod mesh_method(const std::string& name);

struct MethodChoice {
  MeshMethod method = MeshMethod::kVolumetric;
  std::string reason;  ///< one sentence
};

/// What suits the scans: volumetric where scans have grids and know where they were seen from;
/// Poisson for oriented clouds whose normals look to all sides, so that they go around something;
/// advancing front for oriented clouds that do not; scale space for points and nothing else.
/// Throws Error when there is no point.
MethodChoice choose_method(const ScanProject& project);

struct MeshScansOptions {
  double voxel = 0;     ///< of the volume, or what points are thinned to [m]; 0 = from the sampling
  double max_edge = 0;  ///< longest edge of the methods that join points [m]; 0 = their own
  double max_memory = VolumetricOptions{}.max_memory;  ///< for the volume [byte]
  int num_threads = 0;                                 ///< 0 = all cores [1]

  void check() const;
};

struct MeshedScans {
  TriangleMesh mesh;       ///< world frame
  double voxel = 0;        ///< used [m]; 0 = none
  std::size_t points = 0;  ///< the surface was made of, after thinning [1]
};

/// Makes the mesh. Thins, and estimates normals, where the method asks for it. Throws
/// VolumeMemoryError where the volume needs more than max_memory.
MeshedScans mesh_scans(const ScanProject& project,
                       MeshMethod method,
                       const MeshScansOptions& options = {});

}  // namespace facula
