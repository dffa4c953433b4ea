// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/commands/demo/demo_mesh.hpp>
#include <facula/apps/commands/mesh_steps.hpp>
#include <facula/reconstruct/mesh/mesh_method.hpp>

#include <utility>

namespace facula {

TriangleMesh mesh_demo_scans(const ScanProject& project,
                             const DemoSettings& settings,
                             Figures& figures) {
  const MethodChoice choice = choose_method(project);
  MeshedScans meshed = mesh_scans(project, choice.method, {.num_threads = settings.num_threads});
  Figures steps;  // the demo shows what came of them
  const MeshVerdict verdict =
      run_mesh_steps(meshed.mesh, project.fused(), meshed.voxel, MeshStepArguments{}, steps);
  figures.text("method", "method", choice.reason);
  figures.number("voxel_mm", "voxel", 1000 * meshed.voxel, 2);
  figures.text("verdict", "verdict", verdict.sentence());
  return std::move(meshed.mesh);
}

}  // namespace facula
