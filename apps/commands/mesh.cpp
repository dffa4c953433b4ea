// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/distance_figures.hpp>
#include <facula/apps/commands/machine_memory.hpp>
#include <facula/apps/commands/mesh.hpp>
#include <facula/apps/commands/mesh_figures.hpp>
#include <facula/apps/commands/mesh_in_blocks.hpp>
#include <facula/apps/commands/mesh_steps.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/reconstruct/filter/outlier_filters.hpp>
#include <facula/reconstruct/filter/scan_filters.hpp>
#include <facula/reconstruct/mesh/distance_volume.hpp>
#include <facula/reconstruct/mesh/mesh_exchange.hpp>
#include <facula/reconstruct/mesh/mesh_method.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>

#include <memory>
#include <optional>

namespace facula {
namespace {

constexpr Unit kGigabytes{"GB", 1e9};
constexpr double kShareOfMachine = 0.75;  // where --memory-gb says nothing; scans take the rest
// Cleaning and judging a mesh take some four times as much as the volume it comes from.
constexpr double kShareOfVolume = 0.2;

struct MeshArguments {
  std::vector<std::filesystem::path> scans;
  std::vector<std::filesystem::path> out;
  std::string method = "auto";
  double voxel = 0;     ///< 0 = chosen from the sampling [m]
  double max_edge = 0;  ///< 0 = the method's own [m]
  double memory = 0;    ///< 0 = a share of the machine's [byte]
  bool no_filter = false;
  MeshStepArguments steps;
  std::filesystem::path compare;
};

/// A mesh with the points it was made of and the voxel of its volume (0 where there was none).
struct Made {
  TriangleMesh mesh;
  PointCloud cloud;
  double voxel = 0;
};

void declare(Arguments& arguments, MeshArguments& a) {
  arguments.inputs("SCANS", a.scans, "a scan, several, or a project (poses.toml, .conf, folder)");
  arguments.required();
  arguments.outputs("--out", a.out, "the mesh: .ply, .obj, .stl, .off or .glb");
  arguments.required();
  arguments.choice(
      "--method",
      a.method,
      {"auto", "volumetric", "poisson", "advancing-front", "scale-space", "alpha-wrap", "grid"},
      "auto chooses by what the scans hold and says why; grid: along rows and columns "
      "of one scan");
  arguments.number("--voxel-mm",
                   a.voxel,
                   kMillimetres,
                   "edge of the volume's voxels, or what the points are thinned to; 0 = from the "
                   "sampling");
  arguments.number(
      "--max-edge-mm", a.max_edge, kMillimetres, "longest edge, 0 = chosen from the points");
  arguments.flag("--no-filter", a.no_filter, "keep mixed points and outliers");
  declare_mesh_steps(arguments, a.steps);
  arguments.number("--memory-gb",
                   a.memory,
                   kGigabytes,
                   "a volumetric mesh that needs more is merged in blocks and written to a .ply as "
                   "it comes, without steps and verdict; 0 = three quarters of the machine's");
  arguments.input("--compare", a.compare, "a reference mesh in metres: report distances to it");
}

Made grid_mesh(const MeshArguments& a, Figures& figures) {
  require(a.scans.size() == 1 && file_kind(a.scans.front()) == FileKind::kScan,
          "expected one scan with a grid (.pcd of 'facula extract') for --method grid, got '",
          a.scans.front().string(),
          a.scans.size() > 1 ? "' and more" : "'",
          "; use --method auto");
  PolarScan scan = read_scan(a.scans.front());
  require_surface(scan.valid_count(), stripes_of(scan), a.scans.front());
  figures.count("points", "points", scan.valid_count());
  if (!a.no_filter) {
    figures.count("mixed_removed", "mixed points removed", remove_mixed_points(scan));
  }
  GridMeshOptions options;
  if (a.max_edge > 0) options.max_edge = a.max_edge;
  return {transformed(mesh_grid(scan, options), scan.world_from_scan),
          transformed(cloud_from_scan(scan), scan.world_from_scan),
          0};
}

/// Scans as the volume takes them, or one outlier-free cloud for the methods that join points.
ScanProject cleaned_scans(const MeshArguments& a, Session& session) {
  session.step("reading and filtering", 1, 4);
  PosedScans scans = read_posed_scans(a.scans, !a.no_filter);
  require_surface(scans.points_read, scans.stripes, a.scans.front());
  session.figures.count("points", "points", scans.points_read);
  if (!a.no_filter) {
    session.figures.count("mixed_removed", "mixed points removed", scans.mixed_removed);
  }
  return std::move(scans.project);
}

MeshMethod chosen_method(const MeshArguments& a, const ScanProject& project, Figures& figures) {
  if (a.method != "auto") return mesh_method(a.method);
  const MethodChoice choice = choose_method(project);
  figures.text("method_reason", "method chosen", choice.reason);
  return choice.method;
}

/// The volume weighs outliers down by itself; methods that join points would run through them.
ScanProject without_outliers(const ScanProject& project, int num_threads, Figures& figures) {
  const PointCloud cloud = project.fused();
  ScanProject result;
  result.scans.emplace_back();
  result.scans.front().cloud =
      selected(cloud, statistical_inliers(cloud, {.num_threads = num_threads}));
  figures.count(
      "outliers_removed", "outliers removed", cloud.size() - result.scans.front().cloud.size());
  return result;
}

double memory_of(const MeshArguments& a) {
  return a.memory > 0 ? a.memory : kShareOfMachine * machine_memory();
}

/// What the memory does not hold can be merged and written piece by piece, but nothing more.
void mesh_beyond_memory(const MeshArguments& a, const ScanProject& project, Session& session) {
  const bool only_merge = !asks_for_steps(a.steps) && a.compare.empty();
  require(only_merge && a.out.size() == 1 && lower_extension(a.out.front()) == ".ply",
          "expected one .ply and no step for a mesh that needs more than ",
          1e-9 * memory_of(a),
          " GB, since it is written as it comes; leave out ",
          only_merge ? "the other outputs" : "the steps and --compare",
          ", take a larger --voxel-mm, or allow more by --memory-gb");
  session.end_steps();
  mesh_in_blocks(project,
                 {.voxel = a.voxel,
                  .max_memory = memory_of(a),
                  .num_threads = session.num_threads,
                  .progress = session.progress("merging in blocks")},
                 a.out.front(),
                 session.figures);
}

/// Nothing where the mesh was larger than the memory and has been written.
std::optional<Made> make_mesh(const MeshArguments& a, Session& session) {
  if (a.method == "grid") return grid_mesh(a, session.figures);
  ScanProject project = cleaned_scans(a, session);
  const MeshMethod method = chosen_method(a, project, session.figures);
  session.figures.text("method", "method", to_string(method));
  const bool joins_points = method != MeshMethod::kVolumetric;
  if (joins_points && !a.no_filter) {
    project = without_outliers(project, session.num_threads, session.figures);
  }
  session.step("meshing by " + to_string(method), 2, 4);
  MeshedScans meshed;
  try {
    meshed = mesh_scans(project,
                        method,
                        {.voxel = a.voxel,
                         .max_edge = a.max_edge,
                         .max_memory = kShareOfVolume * memory_of(a),
                         .num_threads = session.num_threads});
  } catch (const VolumeMemoryError&) {
    mesh_beyond_memory(a, project, session);
    return std::nullopt;
  }
  if (meshed.voxel > 0) {
    session.figures.number(
        "voxel_mm", joins_points ? "points thinned to" : "voxel", 1000 * meshed.voxel, 3);
  }
  return Made{std::move(meshed.mesh), project.fused(), joins_points ? 0 : meshed.voxel};
}

void run(const MeshArguments& a, Session& session) {
  for (const auto& path : a.out) check_output(path, {".ply", ".obj", ".stl", ".off", ".glb"});
  require(a.voxel >= 0 && a.max_edge >= 0 && a.memory >= 0,
          "expected --voxel-mm, --max-edge-mm and --memory-gb of 0 or more, got ",
          1000 * a.voxel,
          ", ",
          1000 * a.max_edge,
          " and ",
          1e-9 * a.memory,
          "; leave them out for the defaults");
  check_mesh_steps(a.steps);
  // A reference that cannot be read shall not come to light after minutes of meshing.
  TriangleMesh reference;
  if (!a.compare.empty()) reference = read_any_mesh(a.compare);
  std::optional<Made> made = make_mesh(a, session);
  if (!made) return;
  require(!made->mesh.empty(),
          "expected a surface through the points, got no triangle; try a larger "
          "--max-edge-mm");
  session.step("cleaning and judging", 3, 4);
  MeshStepArguments steps = a.steps;
  steps.num_threads = session.num_threads;
  const MeshVerdict verdict =
      run_mesh_steps(made->mesh, made->cloud, made->voxel, steps, session.figures);
  for (const auto& path : a.out) write_mesh(path, made->mesh);
  report_verdict(verdict, session.figures);
  for (std::size_t i = 0; i < a.out.size(); ++i) {
    session.figures.text("out_" + std::to_string(i + 1), "written", a.out[i].string());
  }
  if (a.compare.empty()) return;
  session.step("comparing", 4, 4);
  report_distances(distances_to_mesh(made->mesh.vertices, reference, session.num_threads),
                   session.figures.part("compare", "Distance of vertices to the reference:"));
  report_distances(distances_to_mesh(reference.vertices, made->mesh, session.num_threads),
                   session.figures.part("compare_back", "Distance of the reference's vertices:"));
}

}  // namespace

Command mesh_command() {
  const auto a = std::make_shared<MeshArguments>();
  return {
      .name = "mesh",
      .summary = "make a triangle mesh of scans",
      .description =
          "Removes mixed points and outliers, lays a surface through or between the points by the "
          "method that suits them, cleans it, and says what the mesh is worth: closed or its "
          "boundary loops, manifold, self-intersections, volume, distance of the points.",
      .examples = {"facula simulate data/scenes/turntable_object.toml --rig "
                   "data/rigs/ciclop_turntable.toml --step-deg 10 --out object",
                   "facula extract object --out object.pcd",
                   "facula mesh object.pcd --out object.ply --out object.glb",
                   "facula filter object.pcd --lowest-mm 5 --out jug.pcd",
                   "facula mesh jug.pcd --keep-largest --watertight --max-error-mm 0.5 --out "
                   "jug.stl",
                   "facula mesh jug.pcd --method grid --max-edge-mm 20 --out grid.ply --compare "
                   "jug.stl"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
