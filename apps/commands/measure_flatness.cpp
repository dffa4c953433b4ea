// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/csv_figures.hpp>
#include <facula/apps/commands/flatness_figures.hpp>
#include <facula/apps/commands/measure_flatness.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/measure/plane.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <numeric>

namespace facula {
namespace {

struct FlatnessArguments {
  std::vector<std::filesystem::path> scans;
  std::filesystem::path csv;
  std::optional<double> inlier_distance;
  PlaneExtractionOptions search;
  std::size_t seed = 1;
  bool whole = false;
  FlatnessUncertaintyOptions noise;
};

void declare(Arguments& arguments, FlatnessArguments& a) {
  arguments.inputs("SCANS", a.scans, "a scan, several, or a project (poses.toml, .conf, folder)");
  arguments.required();
  arguments.output("--csv", a.csv, "also write the table (.csv)");
  arguments.flag("--whole", a.whole, "all points are of one surface; look for no planes");
  arguments.number("--inlier-mm",
                   a.inlier_distance,
                   kMillimetres,
                   "farthest from a plane that a point of it lies; more than its flatness");
  arguments.whole("--min-points", a.search.min_points, "smallest plane");
  arguments.whole("--max-planes", a.search.max_planes, "stop after this many");
  arguments.number(
      "--sigma-mm", a.noise.sigma, kMillimetres, "noise of points that do not know their own");
  arguments.whole("--trials", a.noise.trials, "draws of noise for the uncertainty");
  arguments.whole("--seed", a.seed, "of the search and of the draws");
}

/// The points of each surface.
std::vector<std::vector<std::size_t>> surfaces_of(PointCloud& cloud,
                                                  const FlatnessArguments& a,
                                                  Session& session) {
  if (a.whole) {
    std::vector<std::size_t> all(cloud.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return {all};
  }
  PlaneExtractionOptions options = a.search;
  options.inlier_distance = a.inlier_distance;
  options.seed = static_cast<unsigned>(a.seed % std::numeric_limits<unsigned>::max());
  options.num_threads = session.num_threads;
  options.check();
  estimate_normals(cloud, {.num_threads = session.num_threads});
  std::vector<std::vector<std::size_t>> surfaces;
  for (ExtractedPlane& plane : extract_planes(cloud, options)) {
    surfaces.push_back(std::move(plane.indices));
  }
  require(!surfaces.empty(),
          "expected a plane of ",
          options.min_points,
          " points or more among ",
          cloud.size(),
          ", got none; lower --min-points, raise --inlier-mm, or give --whole");
  return surfaces;
}

bool knows_noise(const PointCloud& cloud, double other_sigma) {
  if (other_sigma > 0) return true;
  return !cloud.sigma.empty() &&
         std::all_of(cloud.sigma.begin(), cloud.sigma.end(), [](float s) { return s > 0; });
}

void run(const FlatnessArguments& a, Session& session) {
  if (!a.csv.empty()) check_output(a.csv, {".csv"});
  a.noise.check();
  session.step("reading", 1, 3);
  const PosedScans scans = read_posed_scans(a.scans);
  require_surface(scans.points_read, scans.stripes, a.scans.front());
  PointCloud cloud = scans.project.fused();
  session.figures.count("points", "points", scans.points_read);
  session.step("looking for planes", 2, 3);
  const auto surfaces = surfaces_of(cloud, a, session);
  session.step("measuring", 3, 3);
  FlatnessUncertaintyOptions noise = a.noise;
  noise.seed = static_cast<unsigned>(a.seed % std::numeric_limits<unsigned>::max());
  noise.num_threads = session.num_threads;
  std::vector<MeasuredFlatness> measured;
  for (const auto& indices : surfaces) {
    MeasuredFlatness surface;
    surface.flatness =
        measure_flatness(cloud, indices, FlatnessOptions{.num_threads = session.num_threads});
    if (knows_noise(cloud, noise.sigma)) {
      surface.uncertainty = flatness_uncertainty(cloud, indices, surface.flatness, noise);
    }
    measured.push_back(std::move(surface));
  }
  FigureTable table = flatness_table(measured);
  if (!a.csv.empty()) write_table_csv(a.csv, table);
  session.figures.count("plane_count", "planes", measured.size());
  session.figures.table(std::move(table));
  session.figures.note("Plane 1: " + flatness_verdict(measured.front()));
}

}  // namespace

Command measure_flatness_command() {
  const auto a = std::make_shared<FlatnessArguments>();
  return {
      .name = "measure flatness",
      .summary = "flatness after ISO 12781, with the minimum zone",
      .description =
          "Finds the planes in a cloud and measures their flatness: FLTt, FLTp, FLTv and FLTq from "
          "the least-squares plane, and the minimum zone, exact. Noise makes FLTt of a scan too "
          "large, the more the more points there are; where the noise is known, the table says "
          "how large FLTt of a perfectly flat surface would be.",
      .examples = {"facula simulate data/scenes/flat_wall.toml --rig data/rigs/head_fs1500.toml "
                   "--from-deg -20 --to-deg 20 --step-deg 2 --out wall",
                   "facula extract wall --out wall.pcd",
                   "facula measure flatness wall.pcd --inlier-mm 20 --csv flatness.csv"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
