// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/filter.hpp>
#include <facula/apps/commands/filter_chain.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/smoothing.hpp>

#include <cmath>
#include <memory>

namespace facula {
namespace {

struct FilterArguments {
  std::vector<std::filesystem::path> scans;
  std::filesystem::path out;
  bool keep_mixed = false;
  double max_deviation = MixedPointOptions{}.max_deviation;
  std::optional<double> nearest;
  std::optional<double> farthest;
  std::optional<double> lowest;
  std::optional<double> highest;
  std::optional<double> max_incidence;
  int statistical = 0;
  double max_ratio = StatisticalFilterOptions{}.max_ratio;
  std::optional<double> radius;
  int radius_neighbours = 4;
  std::optional<double> smooth;
  int smooth_order = 2;
  std::optional<double> voxel;
};

void declare(Arguments& arguments, FilterArguments& a) {
  arguments.inputs("SCANS", a.scans, "a scan, or clouds and projects, which are written as one");
  arguments.required();
  arguments.output("--out", a.out, "what is kept: .pcd, .ply or .xyz");
  arguments.required();
  arguments.flag("--keep-mixed", a.keep_mixed, "leave the points between two surfaces");
  arguments.number("--max-deviation",
                   a.max_deviation,
                   kPlainNumber,
                   "sigmas that a point beside an edge may lie off its surface, 0 = any");
  arguments.number("--nearest-mm", a.nearest, kMillimetres, "drop points nearer to the sensor");
  arguments.number("--farthest-mm", a.farthest, kMillimetres, "drop points farther away");
  arguments.number("--lowest-mm", a.lowest, kMillimetres, "drop points below this z of the world");
  arguments.number(
      "--highest-mm", a.highest, kMillimetres, "drop points above this z of the world");
  arguments.number("--max-incidence-deg",
                   a.max_incidence,
                   kDegrees,
                   "drop points whose surface is seen flatter, 0 = square");
  arguments.whole("--statistical",
                  a.statistical,
                  "drop points unusually far from this many neighbours, 0 = none");
  arguments.number("--max-ratio",
                   a.max_ratio,
                   kPlainNumber,
                   "standard deviations above the mean distance that are usual");
  arguments.number(
      "--radius-mm", a.radius, kMillimetres, "drop points with too few others so near");
  arguments.whole("--radius-neighbours", a.radius_neighbours, "others that --radius-mm asks for");
  arguments.number("--smooth-mm",
                   a.smooth,
                   kMillimetres,
                   "move points onto their neighbours' surface: half width of the weights");
  arguments.whole("--smooth-order", a.smooth_order, "of that surface, 1 = plane, 2 = paraboloid");
  arguments.number("--voxel-mm",
                   a.voxel,
                   kMillimetres,
                   "one mean point per voxel at the end, weighted by sigma");
}

FilterChain chain_of(const FilterArguments& a, int num_threads) {
  FilterChain chain;
  chain.mixed = !a.keep_mixed;
  chain.mixed_options.max_deviation = a.max_deviation;
  chain.num_threads = num_threads;
  if (a.nearest || a.farthest) {
    chain.range = RangeGate{a.nearest.value_or(0), a.farthest.value_or(INFINITY)};
    chain.range->check();
  }
  if (a.lowest || a.highest) {
    chain.height = HeightGate{a.lowest.value_or(-INFINITY), a.highest.value_or(INFINITY)};
    chain.height->check();
  }
  chain.max_incidence = a.max_incidence;
  if (a.statistical > 0) {
    chain.statistical = StatisticalFilterOptions{a.statistical, a.max_ratio, num_threads};
    chain.statistical->check();
  }
  if (a.radius) {
    chain.radius = RadiusFilterOptions{*a.radius, a.radius_neighbours, num_threads};
    chain.radius->check();
  }
  return chain;
}

/// What was removed, summed over all scans, and what is kept.
struct Filtered {
  PointCloud cloud;               ///< of all scans, in the world
  std::optional<PolarScan> scan;  ///< of the one scan, cleared
  FilterVerdict verdict;
};

void count(FilterVerdict& sum, const FilterVerdict& more) {
  sum.reason.insert(sum.reason.end(), more.reason.begin(), more.reason.end());
  for (std::size_t k = 0; k < kRemovals; ++k) sum.count_of[k] += more.count_of[k];
}

Filtered filter_all(const FilterArguments& a, Session& session) {
  Filtered filtered;
  FilterChain chain = chain_of(a, session.num_threads);
  for (const PosedCloud& posed : read_posed_scans(a.scans, false).project.scans) {
    GriddedCloud points{posed.cloud, posed.grid};
    std::optional<PolarScan> scan;
    const bool may_be_grid = posed.file.extension() == ".pcd" && !posed.grid.empty();
    if (may_be_grid && file_kind(posed.file) == FileKind::kScan) scan = read_scan(posed.file);
    chain.world_from_scan = posed.world_from_scan;
    const FilterVerdict verdict = run_filters(points, scan ? &*scan : nullptr, chain);
    count(filtered.verdict, verdict);
    append(filtered.cloud, transformed(points.cloud, posed.world_from_scan));
    if (scan) clear_removed(*scan, verdict);
    filtered.scan = std::move(scan);
  }
  return filtered;
}

/// Puts points and sigmas back into the cells they came from.
void put_back(PolarScan& scan, const PointCloud& world) {
  const PointCloud cloud = transformed(world, scan.world_from_scan.inverse());
  std::size_t next = 0;
  for (std::size_t cell = 0; cell < scan.valid.size(); ++cell) {
    if (scan.valid[cell] == 0) continue;
    const float intensity = scan.intensity[cell];
    scan.set(cell, cloud.points[next].cast<double>(), intensity, cloud.sigma[next]);
    ++next;
  }
}

void report_counts(const FilterVerdict& verdict, Figures& figures) {
  figures.count("points", "points", verdict.reason.size());
  figures.count("kept", "kept", verdict.count(Removal::kKept));
  Figures& removed = figures.part("removed", "Removed:");
  removed.count(
      "mixed", "between two surfaces or off theirs beside an edge", verdict.count(Removal::kMixed));
  removed.count("range", "outside the gate of range or height", verdict.count(Removal::kRange));
  removed.count("incidence", "seen too flat", verdict.count(Removal::kIncidence));
  removed.count("statistical", "far from their neighbours", verdict.count(Removal::kStatistical));
  removed.count("radius", "with too few others around", verdict.count(Removal::kRadius));
  removed.count("not_finite", "not finite", verdict.count(Removal::kNotFinite));
}

void smooth_all(const FilterArguments& a, Filtered& filtered, Session& session) {
  SmoothedCloud smoothed =
      smooth(filtered.cloud,
             {.radius = *a.smooth, .order = a.smooth_order, .num_threads = session.num_threads});
  session.figures.count("smoothed", "points smoothed", smoothed.moved);
  session.figures.number("smoothing_mm", "moved, median", 1000 * smoothed.median_move, 3);
  session.figures.number("sigma_ratio", "sigma after / before", smoothed.median_sigma_ratio, 3);
  filtered.cloud = std::move(smoothed.cloud);
  if (filtered.scan) put_back(*filtered.scan, filtered.cloud);
}

void run(const FilterArguments& a, Session& session) {
  check_output(a.out, {".pcd", ".ply", ".xyz"});
  Filtered filtered = filter_all(a, session);
  report_counts(filtered.verdict, session.figures);
  require(!filtered.cloud.empty(),
          "every one of the ",
          filtered.verdict.reason.size(),
          " points was removed; widen the gates");
  const bool one_grid = a.scans.size() == 1 && filtered.scan && !a.voxel &&
                        filtered.scan->valid_count() == filtered.cloud.size();
  if (!one_grid) filtered.scan.reset();
  if (a.smooth) smooth_all(a, filtered, session);
  if (a.voxel) {
    filtered.cloud = thin_by_voxel(filtered.cloud, *a.voxel);
    session.figures.count("thinned", "points after thinning", filtered.cloud.size());
  }
  const bool organised = one_grid && a.out.extension() == ".pcd";
  if (organised) {
    write_scan(a.out, *filtered.scan);
  } else {
    write_cloud(a.out, filtered.cloud);
  }
  session.figures.flag("organised", "grid kept", organised);
  session.figures.text("out", "written", a.out.string());
}

}  // namespace

Command filter_command() {
  const auto a = std::make_shared<FilterArguments>();
  return {.name = "filter",
          .summary = "remove what is no surface, and say why",
          .description =
              "Removes points that are no surface: by default those between two surfaces or off "
              "theirs beside a depth edge (where the scan has its grid), and by the options given "
              "those out of range or height, seen too flat, far from their neighbours or alone; "
              "then smooths "
              "and thins. Counts every reason. One scan keeps its grid (.pcd); several are written "
              "as one cloud in the world frame. docs/filters.md explains each filter.",
          .examples = {"facula simulate data/scenes/furnished_room.toml --rig "
                       "data/rigs/head_fs1500.toml --from-deg 0 --to-deg 30 --step-deg 3 "
                       "--position-mm -1500 -300 1100 --out room",
                       "facula extract room --out room.pcd",
                       "facula filter room.pcd --farthest-mm 4000 --max-incidence-deg 80 --out "
                       "clean.pcd",
                       "facula filter room.pcd --statistical 16 --smooth-mm 150 --out smooth.pcd",
                       "facula filter room.pcd --radius-mm 100 --voxel-mm 20 --out thin.ply"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
