// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/apps/cli/data_folder.hpp>
#include <facula/apps/commands/demo/demo_mesh.hpp>
#include <facula/apps/commands/demo/object_demo.hpp>
#include <facula/apps/commands/demo/range_error.hpp>
#include <facula/apps/commands/demo/surface_error.hpp>

namespace facula {
namespace {

TriangleMesh mesh_object(const PolarScan& scan, const DemoSettings& settings, Figures& figures) {
  ScanProject project;
  project.scans.push_back({"object", {}, cloud_from_scan(scan), {}, grid_from_scan(scan)});
  return mesh_demo_scans(project, settings, figures);
}

}  // namespace

ObjectDemo run_object_demo(const DemoSettings& settings, Session& session) {
  const Scene scene = read_scene(resolved_input("data/scenes/turntable_object.toml"));
  const Rig rig = read_rig(resolved_input("data/rigs/ciclop_turntable.toml"));
  ObjectDemo demo;
  demo.scan = record({"object", &scene, &rig, {}, settings.object_step}, settings, session);
  write_scan(settings.folder / "scans" / "object.pcd", demo.scan.extracted.scan);
  RangeErrors errors;
  errors.add(demo.scan.clean, demo.scan.truth);
  Figures& scan_figures = session.figures.part("object", "7 Scan of the object on the turntable:");
  scan_figures.count("mixed_removed", "mixed points removed", demo.scan.mixed_removed);
  report_range_errors(errors, scan_figures);
  session.step("meshing the object", 1, 1);
  Figures& mesh_figures = session.figures.part("object_mesh", "8 Mesh of the object:");
  demo.mesh = mesh_object(demo.scan.clean, settings, mesh_figures);
  write_mesh(settings.folder / "object_mesh.ply", demo.mesh);
  report_mesh_error(demo.mesh, scene, settings.num_threads, mesh_figures);
  session.end_steps();
  return demo;
}

}  // namespace facula
