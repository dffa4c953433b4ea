// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/distance_figures.hpp>
#include <facula/apps/commands/mesh.hpp>
#include <facula/apps/commands/mesh_figures.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>
#include <facula/reconstruct/filter/scan_filters.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>

#include <memory>

namespace facula {
namespace {

struct MeshArguments {
  std::vector<std::filesystem::path> scans;
  std::vector<std::filesystem::path> out;
  std::string method = "advancing-front";
  double voxel = 0;     ///< 0 = chosen from the sampling [m]
  double max_edge = 0;  ///< 0 = the method's own [m]
  bool no_filter = false;
  std::filesystem::path compare;
};

void declare(Arguments& arguments, MeshArguments& a) {
  arguments.inputs("SCANS", a.scans, "a scan, several, or a project (poses.toml, .conf, folder)");
  arguments.required();
  arguments.outputs("--out", a.out, "the mesh: .ply, .obj or .stl");
  arguments.required();
  arguments.choice("--method",
                   a.method,
                   {"advancing-front", "grid"},
                   "advancing-front: a surface through all points; grid: along rows and columns of "
                   "one scan");
  arguments.number("--voxel-mm",
                   a.voxel,
                   kMillimetres,
                   "thin the points to this first, 0 = half the step from stripe to stripe where "
                   "that is coarse");
  arguments.number(
      "--max-edge-mm", a.max_edge, kMillimetres, "longest edge, 0 = chosen from the points");
  arguments.flag("--no-filter", a.no_filter, "keep mixed points and outliers");
  arguments.input("--compare", a.compare, "a reference mesh in metres: report distances to it");
}

TriangleMesh grid_mesh(const MeshArguments& a, Figures& figures) {
  require(a.scans.size() == 1 && file_kind(a.scans.front()) == FileKind::kScan,
          "expected one scan with a grid (.pcd of 'facula extract') for --method grid, got '",
          a.scans.front().string(),
          a.scans.size() > 1 ? "' and more" : "'",
          "; use --method advancing-front");
  PolarScan scan = read_scan(a.scans.front());
  require_surface(scan.valid_count(), stripes_of(scan), a.scans.front());
  figures.count("points", "points", scan.valid_count());
  if (!a.no_filter) {
    figures.count("mixed_removed", "mixed points removed", remove_mixed_points(scan));
  }
  GridMeshOptions options;
  if (a.max_edge > 0) options.max_edge = a.max_edge;
  return transformed(mesh_grid(scan, options), scan.world_from_scan);
}

PointCloud cleaned_cloud(const MeshArguments& a, Session& session) {
  session.step("reading and filtering", 1, 3);
  const PosedScans scans = read_posed_scans(a.scans, !a.no_filter);
  require_surface(scans.points_read, scans.stripes, a.scans.front());
  PointCloud cloud = scans.project.fused();
  session.figures.count("points", "points", scans.points_read);
  if (!a.no_filter) {
    const std::size_t before = cloud.size();
    cloud = selected(cloud, statistical_inliers(cloud));
    session.figures.count("mixed_removed", "mixed points removed", scans.mixed_removed);
    session.figures.count("outliers_removed", "outliers removed", before - cloud.size());
  }
  // Points dense along the stripe and far from stripe to stripe would make slivers.
  if (const double voxel = a.voxel > 0 ? a.voxel : evening_voxel(cloud); voxel > 0) {
    cloud = thin_by_voxel(cloud, voxel);
    session.figures.number("voxel_mm", "points thinned to", 1000 * voxel, 3);
    session.figures.count("thinned_points", "points after thinning", cloud.size());
  }
  return cloud;
}

TriangleMesh make_mesh(const MeshArguments& a, Session& session) {
  if (a.method == "grid") return grid_mesh(a, session.figures);
  const PointCloud cloud = cleaned_cloud(a, session);
  session.step("meshing " + std::to_string(cloud.size()) + " points", 2, 3);
  AdvancingFrontOptions options;
  options.max_edge = a.max_edge;
  return mesh_advancing_front(cloud, options);
}

void run(const MeshArguments& a, Session& session) {
  for (const auto& path : a.out) check_output(path, {".ply", ".obj", ".stl"});
  require(a.voxel >= 0 && a.max_edge >= 0,
          "expected --voxel-mm and --max-edge-mm of 0 or more, "
          "got ",
          1000 * a.voxel,
          " and ",
          1000 * a.max_edge,
          "; leave them out for the defaults");
  // A reference that cannot be read shall not come to light after minutes of meshing.
  TriangleMesh reference;
  if (!a.compare.empty()) reference = read_mesh(a.compare);
  const TriangleMesh mesh = make_mesh(a, session);
  require(!mesh.empty(),
          "expected a surface through the points, got no triangle; try a larger "
          "--max-edge-mm");
  for (const auto& path : a.out) write_mesh(path, mesh);
  report_mesh(mesh, session.figures);
  if (!a.compare.empty()) {
    session.step("comparing", 3, 3);
    report_distances(distances_to_mesh(mesh.vertices, reference),
                     session.figures.part("compare", "Distance of vertices to the reference:"));
  }
}

}  // namespace

Command mesh_command() {
  const auto a = std::make_shared<MeshArguments>();
  return {.name = "mesh",
          .summary = "make a triangle mesh of scans",
          .description =
              "Removes mixed points and outliers, evens out the sampling, lays a surface "
              "through them, and says how large and how closed it is. Points are not moved.",
          .examples = {"facula simulate data/scenes/turntable_object.toml --rig "
                       "data/rigs/ciclop_turntable.toml --step-deg 10 --out object",
                       "facula extract object --out object.pcd",
                       "facula mesh object.pcd --voxel-mm 2 --out object.ply --out object.stl",
                       "facula mesh object.pcd --method grid --max-edge-mm 20 --out grid.ply "
                       "--compare object.ply"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
