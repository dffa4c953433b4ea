// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/plane_search.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/grid_normals.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/measure/pose_errors.hpp>
#include <facula/reconstruct/measure/principal_frame.hpp>
#include <facula/reconstruct/register/pan_tilt_list.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace facula {
namespace {

/// The cloud to search, with the grid of the only scan where there is one.
struct SearchedCloud {
  PointCloud cloud;
  ScanGrid grid;
  PoseErrors poses;
  std::size_t doubles = 0;  ///< points left out, for another stands in the same place [1]
};

/// No plane goes through points of one line, whatever the options.
void require_spread(const SearchedCloud& searched) {
  require(spans_surface(searched.cloud),
          "expected points of a surface, got ",
          searched.cloud.size() + searched.doubles,
          " on one line or in one spot, which no plane fits; choose another file");
}

SearchedCloud searched_points(const ScanProject& project) {
  if (project.scans.size() == 1 && !project.scans[0].grid.empty()) {
    return {project.fused(), project.scans[0].grid, pose_errors(project)};
  }
  FusedScans fused = fuse_apart(project);
  return {std::move(fused.cloud), {}, std::move(fused.poses), fused.doubles};
}

/// Normals tell the faces of a wall from the points in front of it.
void add_normals(SearchedCloud& searched, int num_threads) {
  if (searched.grid.empty()) {
    estimate_normals(searched.cloud, {.num_threads = num_threads});
  } else {
    searched.cloud.normals =
        grid_normals(searched.cloud, searched.grid, {.num_threads = num_threads});
  }
}

/// Largest first. Sets the inlier distance where none was given.
std::vector<ExtractedPlane> planes_in(const SearchedCloud& searched,
                                      PlaneExtractionOptions& options) {
  if (!options.inlier_distance) {
    options.inlier_distance = default_inlier_distance(searched.cloud);
    options.widen_by_sigma = true;
  }
  std::vector<ExtractedPlane> planes = searched.grid.empty()
                                           ? extract_planes(searched.cloud, options)
                                           : grow_planes(searched.cloud, searched.grid, options);
  add_pose_responses(searched.cloud, searched.poses, planes);
  return planes;
}

bool all_lists(const std::vector<std::filesystem::path>& paths) {
  return std::all_of(paths.begin(), paths.end(), is_pan_tilt_list);
}

/// The sweeps asked for. Both together carry the play of the gears, which looks like noise.
PanTiltList chosen_sweeps(const PlaneSearch& search, Session& session) {
  const PanTiltList all = read_pan_tilt_list(search.scans.front());
  const PanTiltSweeps sweeps = sweeps_of(all);
  const PanTiltList& list = search.sweeps == "rising"    ? sweeps.rising
                            : search.sweeps == "falling" ? sweeps.falling
                                                         : all;
  require(list.size() > 0,
          "expected ",
          search.sweeps,
          " sweeps in '",
          search.scans.front().string(),
          "', got none; leave --sweeps out");
  if (search.sweeps == "both" &&
      std::min(sweeps.rising.size(), sweeps.falling.size()) > list.size() / 10) {
    session.figures.note(
        "The list holds rising and falling sweeps; the play of the gears shows between them and "
        "counts as noise. --sweeps rising measures one way only.");
  }
  return list;
}

SearchedCloud read_lists(const PlaneSearch& search, Session& session) {
  require(search.scans.size() == 1,
          "expected one list of ranges, got ",
          search.scans.size(),
          "; their poses to each other are not known");
  PosedCloud scan = posed_cloud(chosen_sweeps(search, session), search.tilt_zero);
  session.figures.count("points", "points", scan.cloud.size());
  return {std::move(scan.cloud), std::move(scan.grid), {}};
}

SearchedCloud read_scans(const PlaneSearch& search, Session& session) {
  require(search.tilt_zero == 0,
          "--tilt-zero-deg is for lists of range, pan and tilt, got '",
          search.scans.front().string(),
          "'; leave it out");
  require(search.sweeps == "both",
          "--sweeps is for lists of range, pan and tilt, got '",
          search.scans.front().string(),
          "'; leave it out");
  PosedScans scans = read_posed_scans(search.scans);
  require_surface(scans.points_read, scans.stripes, search.scans.front());
  session.figures.count("points", "points", scans.points_read);
  session.figures.count("mixed_removed", "mixed points removed", scans.mixed_removed);
  SearchedCloud searched = searched_points(scans.project);
  if (searched.doubles > 0) {
    session.figures.count("doubles_removed", "copies of points left out", searched.doubles);
  }
  return searched;
}

SearchedCloud read_searched(const PlaneSearch& search, Session& session) {
  session.step("reading and filtering", 1, 3);
  SearchedCloud searched =
      all_lists(search.scans) ? read_lists(search, session) : read_scans(search, session);
  require_spread(searched);
  if (search.voxel > 0) {
    std::vector<std::uint32_t> voxel_of;
    searched.cloud = thin_by_voxel(searched.cloud, search.voxel, &voxel_of);
    searched.poses = thinned(searched.poses, voxel_of, searched.cloud.size());
    searched.grid = {};
    session.figures.count("thinned_points", "points after thinning", searched.cloud.size());
  }
  if (search.method == "ransac") searched.grid = {};
  require(search.method != "grid" || !searched.grid.empty(),
          "expected a single scan with its grid for --method grid; use --method ransac");
  session.step("estimating normals", 2, 3);
  add_normals(searched, session.num_threads);
  return searched;
}

void report_poses(const PoseErrors& poses, Figures& figures) {
  if (poses.empty()) return;
  const auto& roots = poses.root;
  const auto unsure =
      std::count_if(roots.begin(), roots.end(), [](const auto& root) { return !root.isZero(0); });
  figures.count("unsure_poses", "poses whose uncertainty counts", static_cast<std::size_t>(unsure));
}

}  // namespace

void declare_plane_search(Arguments& arguments, PlaneSearch& search) {
  arguments.inputs("SCANS",
                   search.scans,
                   "a scan, several, a project (poses.toml, .conf, folder), or a .csv of range_mm, "
                   "pan_deg, tilt_deg");
  arguments.required();
  arguments.output("--csv", search.csv, "also write the table (.csv)");
  arguments.number("--inlier-mm",
                   search.options.inlier_distance,
                   kMillimetres,
                   "farthest from the plane that a point of it lies; else 4 times the noise, or 3 "
                   "times a point's own sigma");
  arguments.whole("--min-points", search.options.min_points, "smallest plane");
  arguments.whole("--max-planes", search.options.max_planes, "keep so many, the largest");
  arguments.choice("--method",
                   search.method,
                   {"auto", "grid", "ransac"},
                   "grow planes over the grid of a scan, or draw them from the cloud");
  arguments.whole("--seed", search.seed, "of the random trials");
  arguments.number(
      "--voxel-mm", search.voxel, kMillimetres, "thin the points to this first, 0 = not");
  arguments.number("--tilt-zero-deg",
                   search.tilt_zero,
                   kDegrees,
                   "added to every tilt of a .csv of range_mm, pan_deg, tilt_deg");
  arguments.choice("--sweeps",
                   search.sweeps,
                   {"both", "rising", "falling"},
                   "of such a .csv: by the way the tilt moved");
}

void declare_shared_range(Arguments& arguments, PlaneSearch& search) {
  arguments.number("--shared-range-mm",
                   search.relations.shared_range_sigma,
                   kMillimetres,
                   "standard uncertainty of a range error that all points share");
}

FoundPlanes find_planes(const PlaneSearch& search, Session& session) {
  if (!search.csv.empty()) check_output(search.csv, {".csv"});
  search.relations.check();
  PlaneExtractionOptions options = search.options;
  options.seed = static_cast<unsigned>(search.seed % std::numeric_limits<unsigned>::max());
  options.num_threads = session.num_threads;
  options.check();
  require(search.voxel >= 0,
          "expected --voxel-mm of 0 or more, got ",
          1000 * search.voxel,
          "; leave it out to keep all points");
  SearchedCloud searched = read_searched(search, session);
  session.step("looking for planes", 3, 3);
  FoundPlanes found{.cloud = {}, .planes = planes_in(searched, options)};
  session.end_steps();
  require(!found.planes.empty(),
          "expected a plane of ",
          options.min_points,
          " points or more among ",
          searched.cloud.size(),
          ", got none; lower --min-points or raise --inlier-mm (it was ",
          1000 * *options.inlier_distance,
          " mm)");
  report_poses(searched.poses, session.figures);
  session.figures.number("inlier_mm", "farthest from a plane", 1000 * *options.inlier_distance, 2);
  session.figures.count("plane_count", "planes", found.planes.size());
  found.cloud = std::move(searched.cloud);
  found.inlier_distance = *options.inlier_distance;
  found.widened = options.widen_by_sigma;
  return found;
}

FoundPlanes planes_of(const ScanProject& project, PlaneExtractionOptions options) {
  SearchedCloud searched = searched_points(project);
  add_normals(searched, options.num_threads);
  std::vector<ExtractedPlane> planes = planes_in(searched, options);
  return {std::move(searched.cloud),
          std::move(planes),
          *options.inlier_distance,
          options.widen_by_sigma};
}

const ExtractedPlane& plane_called(const std::vector<ExtractedPlane>& planes, std::size_t number) {
  require(number >= 1 && number <= planes.size(),
          "expected the number of a plane from 1 to ",
          planes.size(),
          ", got ",
          number,
          "; 'facula measure planes' lists them");
  return planes[number - 1];
}

std::vector<std::pair<std::size_t, std::size_t>> plane_pairs(
    const std::vector<ExtractedPlane>& planes, std::size_t reference) {
  if (reference != 0) plane_called(planes, reference);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < planes.size(); ++a) {
    if (reference != 0 && a + 1 != reference) continue;
    for (std::size_t b = reference != 0 ? 0 : a + 1; b < planes.size(); ++b) {
      if (a != b) pairs.emplace_back(a, b);
    }
  }
  return pairs;
}

}  // namespace facula
