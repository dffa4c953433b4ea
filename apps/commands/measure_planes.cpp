// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/measure_planes.hpp>
#include <facula/apps/commands/plane_figures.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/normals.hpp>

#include <limits>
#include <memory>

namespace facula {
namespace {

struct PlaneArguments {
  std::vector<std::filesystem::path> scans;
  std::filesystem::path out;
  PlaneExtractionOptions options;
  std::size_t seed = 1;
  double voxel = 0;  ///< 0 = all points [m]
};

void declare(Arguments& arguments, PlaneArguments& a) {
  arguments.inputs("SCANS", a.scans, "a scan, several, or a project (poses.toml, .conf, folder)");
  arguments.required();
  arguments.output("--out", a.out, "also write the planes as a table (.csv)");
  arguments.number("--inlier-mm",
                   a.options.inlier_distance,
                   kMillimetres,
                   "farthest from the plane that a point of it lies");
  arguments.whole("--min-points", a.options.min_points, "smallest plane");
  arguments.whole("--max-planes", a.options.max_planes, "stop after this many");
  arguments.whole("--seed", a.seed, "of the random trials");
  arguments.number("--voxel-mm", a.voxel, kMillimetres, "thin the points to this first, 0 = not");
}

PointCloud read_points(const PlaneArguments& a, Session& session) {
  session.step("reading and filtering", 1, 3);
  const PosedScans scans = read_posed_scans(a.scans);
  require_surface(scans.points_read, scans.stripes, a.scans.front());
  PointCloud cloud = scans.project.fused();
  session.figures.count("points", "points", scans.points_read);
  session.figures.count("mixed_removed", "mixed points removed", scans.mixed_removed);
  if (a.voxel > 0) {
    cloud = thin_by_voxel(cloud, a.voxel);
    session.figures.count("thinned_points", "points after thinning", cloud.size());
  }
  session.step("estimating normals", 2, 3);
  NormalOptions normals;
  normals.num_threads = session.num_threads;
  estimate_normals(cloud, normals);
  return cloud;
}

void run(const PlaneArguments& a, Session& session) {
  if (!a.out.empty()) check_output(a.out, {".csv"});
  PlaneExtractionOptions options = a.options;
  options.seed = static_cast<unsigned>(a.seed % std::numeric_limits<unsigned>::max());
  options.check();
  require(a.voxel >= 0,
          "expected --voxel-mm of 0 or more, got ",
          1000 * a.voxel,
          "; leave it out to keep all points");
  const PointCloud cloud = read_points(a, session);
  session.step("looking for planes", 3, 3);
  const std::vector<ExtractedPlane> planes = extract_planes(cloud, options);
  require(!planes.empty(),
          "expected a plane of ",
          options.min_points,
          " points or more among ",
          cloud.size(),
          ", got none; lower --min-points or raise --inlier-mm");
  if (!a.out.empty()) write_planes_csv(a.out, planes);
  session.figures.count("plane_count", "planes", planes.size());
  report_planes(planes, session.figures);
}

}  // namespace

Command measure_planes_command() {
  const auto a = std::make_shared<PlaneArguments>();
  return {
      .name = "measure planes",
      .summary = "find planes; flatness, angles, distances",
      .description =
          "Finds the planes in a cloud, largest first, fits each by least squares, and measures "
          "flatness, the angle of every pair, and the distance of parallel pairs. rms is the "
          "standard deviation of the points about the plane, p2v the largest minus the smallest "
          "distance, 4 sigma/D the system error of the scanner over its mean distance D.",
      .examples = {"facula simulate data/scenes/furnished_room.toml --rig "
                   "data/rigs/head_fs1500.toml --step-deg 3 "
                   "--position-mm -1500 -300 1100 --out room",
                   "facula extract room --out room.pcd",
                   "facula measure planes room.pcd --inlier-mm 20 --voxel-mm 50 --out "
                   "planes.csv"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
