// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/reconstruct/mesh/mesh_verdict.hpp>

#include <cstddef>
#include <optional>

namespace facula {

/// What `facula mesh` does to a mesh once it is there, in this order.
struct MeshStepArguments {
  bool keep_largest = false;
  std::optional<double> min_island;  ///< none = 10 voxels of a volumetric merge [m]
  double fill_holes = 0;             ///< [m]
  int smooth = 0;                    ///< pairs of steps [1]
  double remesh = 0;                 ///< [m]
  std::size_t triangles = 0;         ///< [1]
  double max_error = 0;              ///< [m]
  bool watertight = false;
  bool color = false;
  int num_threads = 0;  ///< of all steps, 0 = all cores [1]
};

void declare_mesh_steps(Arguments& arguments, MeshStepArguments& a);

/// Whether any step is asked for by name.
bool asks_for_steps(const MeshStepArguments& a);

/// Throws Error where a number is out of range.
void check_mesh_steps(const MeshStepArguments& a);

/// Cleans the mesh and judges it; figures say what each step did. `voxel` [m] is that of a
/// volumetric merge, else 0; deviations are those of the cloud's points.
MeshVerdict run_mesh_steps(TriangleMesh& mesh,
                           const PointCloud& cloud,
                           double voxel,
                           const MeshStepArguments& a,
                           Figures& figures);

}  // namespace facula
