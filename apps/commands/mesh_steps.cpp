// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/commands/mesh_steps.hpp>
#include <facula/reconstruct/mesh/mesh_cleaning.hpp>
#include <facula/reconstruct/mesh/mesh_color.hpp>
#include <facula/reconstruct/mesh/watertight.hpp>

namespace facula {
namespace {

void repair(TriangleMesh& mesh, Figures& figures) {
  RepairCounts counts;
  mesh = repaired(mesh, &counts);
  const std::size_t removed =
      counts.bad_triangles + counts.double_triangles + counts.crowded_triangles;
  if (removed > 0) figures.count("triangles_removed", "triangles removed as unsound", removed);
  if (counts.turned_triangles > 0) {
    figures.count("triangles_turned", "triangles turned", counts.turned_triangles);
  }
  if (counts.split_vertices > 0) {
    figures.count(
        "vertices_split", "vertices split where pieces only touched", counts.split_vertices);
  }
}

std::size_t remove_islands(TriangleMesh& mesh,
                           double voxel,
                           const MeshStepArguments& a,
                           Figures& figures) {
  const double least = a.min_island.value_or(10 * voxel);
  if (!a.keep_largest && least == 0) return 0;
  std::size_t removed = 0;
  mesh = without_islands(mesh, {.keep_largest = a.keep_largest, .min_diameter = least}, &removed);
  figures.count("islands_removed", "islands removed", removed);
  return removed;
}

void fill(TriangleMesh& mesh, const MeshStepArguments& a, Figures& figures) {
  if (a.fill_holes == 0) return;
  std::size_t filled = 0;
  mesh = fill_holes(mesh, a.fill_holes, &filled);
  figures.count("holes_filled", "holes filled", filled);
}

void simplify(TriangleMesh& mesh, const MeshStepArguments& a, Figures& figures) {
  if (a.triangles == 0 && a.max_error == 0) return;
  figures.count("triangles_before", "triangles before simplifying", mesh.triangles.size());
  mesh = simplified(
      mesh, {.triangles = a.triangles, .max_error = a.max_error, .num_threads = a.num_threads});
}

}  // namespace

void declare_mesh_steps(Arguments& arguments, MeshStepArguments& a) {
  arguments.flag("--keep-largest", a.keep_largest, "keep the largest piece only");
  arguments.number("--min-island-mm",
                   a.min_island,
                   kMillimetres,
                   "remove pieces smaller than this from corner to corner; 10 voxels where scans "
                   "are merged in a volume, else none");
  arguments.number("--fill-holes-mm",
                   a.fill_holes,
                   kMillimetres,
                   "close holes up to this size from corner to corner");
  arguments.whole("--smooth", a.smooth, "pairs of smoothing steps that keep the volume (Taubin)");
  arguments.number("--remesh-mm", a.remesh, kMillimetres, "even triangles with edges so long");
  arguments.whole("--triangles", a.triangles, "simplify to so many triangles");
  arguments.number("--max-error-mm",
                   a.max_error,
                   kMillimetres,
                   "simplify as long as no vertex lies farther than this from the result");
  arguments.flag("--watertight",
                 a.watertight,
                 "close the mesh; verified to be closed, manifold and free of self-intersections, "
                 "or refused");
  arguments.flag("--color", a.color, "colour vertices from the nearest points");
}

bool asks_for_steps(const MeshStepArguments& a) {
  return a.keep_largest || a.min_island.value_or(0) > 0 || a.fill_holes > 0 || a.smooth > 0 ||
         a.remesh > 0 || a.triangles > 0 || a.max_error > 0 || a.watertight || a.color;
}

void check_mesh_steps(const MeshStepArguments& a) {
  require(a.min_island.value_or(0) >= 0 && a.fill_holes >= 0 && a.remesh >= 0 && a.max_error >= 0,
          "expected --min-island-mm, --fill-holes-mm, --remesh-mm and --max-error-mm of 0 or more; "
          "leave them out for the defaults");
  require(
      a.triangles == 0 || a.triangles >= 4, "expected --triangles of 4 or more, got ", a.triangles);
}

MeshVerdict run_mesh_steps(TriangleMesh& mesh,
                           const PointCloud& cloud,
                           double voxel,
                           const MeshStepArguments& a,
                           Figures& figures) {
  repair(mesh, figures);
  std::size_t pieces_removed = remove_islands(mesh, voxel, a, figures);
  require(!mesh.empty(), "no piece of the mesh is left; give a smaller --min-island-mm");
  fill(mesh, a, figures);
  mesh = smoothed(mesh, a.smooth, a.num_threads);
  if (a.remesh > 0) mesh = remeshed(mesh, a.remesh);
  simplify(mesh, a, figures);
  std::optional<MeshVerdict> verdict;
  if (a.watertight) {
    WatertightResult closed = make_watertight(mesh, cloud.points, {.num_threads = a.num_threads});
    figures.text("watertight_by", "made watertight", closed.how);
    pieces_removed += closed.pieces_removed;
    mesh = std::move(closed.mesh);
    verdict = std::move(closed.verdict);
  }
  if (pieces_removed > 0 && !cloud.empty()) {
    figures.note(
        "The distances of the points count all of them, also those of the pieces that were removed "
        "and have no surface now: where these are many, p95 and the largest tell of them.");
  }
  if (a.color) color_mesh(mesh, cloud, a.num_threads);
  return verdict ? *verdict : judge_mesh(mesh, cloud.points, a.num_threads);
}

}  // namespace facula
