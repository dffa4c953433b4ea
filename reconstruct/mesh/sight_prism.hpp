// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/mesh/distance_volume.hpp>

#include <array>
#include <functional>

namespace facula {

/// The space that a triangle sweeps along its lines of sight, from `reach` behind it to `reach` in
/// front of it, cut into slices of voxels across the axis nearest to the lines of sight. Triangles
/// that share an edge share its swept face, so that every voxel of the band is met once.
class SightPrism {
 public:
  /// `truncation` as in DistanceVolumeOptions, in voxels.
  SightPrism(const RangeSurface& surface,
             const TriangleMesh::Triangle& triangle,
             double voxel,
             float truncation);

  /// False where the lines of sight of the three corners do not run side by side.
  bool usable() const { return usable_; }

  /// No fewer than visit_bricks() names [1].
  double bricks_at_most() const;

  /// Calls visit for every brick the prism may meet.
  void visit_bricks(const std::function<void(const BrickPlace&)>& visit) const;

  /// Adds weight and distance to the voxels of the prism in that brick.
  void add_to(const BrickPlace& place, Brick& brick) const;

 private:
  struct Corner {
    Eigen::Vector2f place;  ///< in the slice through `along` = 0 [voxels]
    Eigen::Vector2f drift;  ///< per slice [voxels]
    float along = 0;        ///< place along the slicing axis [voxels]
    float per_slice = 0;    ///< way along the line of sight from slice to slice [voxels]
    float cosine = 1;
    float weight = 1;
    Eigen::Vector2f at(float slice) const { return place + drift * (slice - along); }
  };
  void add_slice(int slice, const BrickPlace& place, Brick& brick) const;
  void add_voxel(VoxelSum& voxel, float slice, const Eigen::Vector3f& share) const;

  std::array<Corner, 3> corners_;
  int axis_ = 2;  ///< slices are taken across this axis
  int u_ = 0;     ///< the other two
  int v_ = 1;
  int first_slice_ = 0;
  int last_slice_ = -1;
  float reach_ = 0;       ///< along the line of sight [voxels]
  float truncation_ = 0;  ///< along the normal [voxels]
  bool usable_ = false;
};

}  // namespace facula
