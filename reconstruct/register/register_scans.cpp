// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/reconstruct/register/joint_refinement.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/reconstruct/register/scan_checks.hpp>
#include <facula/reconstruct/register/scan_edges.hpp>
#include <facula/reconstruct/register/scan_network.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr double kLooseVoxels = 1.0;     // scan sigma while only right and wrong are told apart
constexpr double kTightVoxels = 0.001;   // least scan sigma of refined pairs
constexpr std::size_t kSearchSteps = 4;  // a search takes about as long as this many refinements

/// Over the pairs that are kept [m].
double median_rms(const std::vector<ScanEdge>& edges) {
  std::vector<double> values;
  for (const ScanEdge& edge : edges) {
    if (edge.verdict == EdgeVerdict::kKept) values.push_back(edge.inlier_rms);
  }
  return median(values);
}

bool poses_differ(const ScanProject& project) {
  const RigidTransform first = project.scans.front().world_from_scan.inverse();
  return std::any_of(project.scans.begin(), project.scans.end(), [&](const PosedCloud& scan) {
    const RigidTransform off = first * scan.world_from_scan;
    return off.translation.norm() > 1e-9 || rotation_angle(off) > 1e-9;
  });
}

bool starts_from_given(const ScanProject& project, const RegisterScansOptions& options) {
  return options.start == ScanStart::kGiven ||
         (options.start == ScanStart::kAuto && poses_differ(project));
}

std::vector<ScanEdge> edges_from_given(const ScanProject& project,
                                       const ReadyScans& scans,
                                       const RegisterScansOptions& options,
                                       StageProgress& progress) {
  PoseGuesses given;
  for (const PosedCloud& scan : project.scans) given.emplace_back(scan.world_from_scan);
  return register_guessed(scans,
                          given,
                          {.pair = options.refinement, .reach = options.refinement.max_distance},
                          options,
                          progress);
}

double finest_voxel(const ReadyScans& scans) {
  double voxel = 0;
  for (const std::size_t i : scans.order) {
    voxel = std::max(voxel, scans.pyramids[i]->levels.front().voxel);
  }
  return voxel;
}

/// All pairs that overlap, registered from the poses of the network; edges that joined the network
/// stay in the list only as far as they were refused or given up.
std::vector<ScanEdge> refined(const ReadyScans& scans,
                              const ScanNetwork& network,
                              const RegisterScansOptions& options,
                              StageProgress& progress) {
  const double voxel = finest_voxel(scans);
  PairOptions pair = options.refinement;
  pair.max_distance = 4 * voxel;
  pair.coarsest_level = 0;
  return register_guessed(
      scans, network.world_from_scan, {.pair = pair, .tolerance = 4 * voxel}, options, progress);
}

/// The refined edges, and of the first ones those whose pair was not refined.
std::vector<ScanEdge> merged(std::vector<ScanEdge> refined, const std::vector<ScanEdge>& first) {
  for (const ScanEdge& edge : first) {
    const auto same = [&](const ScanEdge& other) {
      return other.edge.from == edge.edge.from && other.edge.to == edge.edge.to;
    };
    if (edge.verdict != EdgeVerdict::kKept && std::none_of(refined.begin(), refined.end(), same)) {
      refined.push_back(edge);
    }
  }
  return refined;
}

}  // namespace

const char* to_string(EdgeVerdict verdict) {
  switch (verdict) {
    case EdgeVerdict::kKept:
      return "kept";
    case EdgeVerdict::kOutlier:
      return "outlier";
    case EdgeVerdict::kRefused:
      return "refused";
  }
  return "unknown";
}

void RegisterScansOptions::check() const {
  motion.check();
  pyramid.check();
  global.check();
  refinement.check();
  graph.check();
  require(min_overlap > 0 && min_overlap <= 1,
          "min_overlap is ",
          min_overlap,
          "; give a share above 0 and at most 1");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

RegisterScansResult register_scans(ScanProject& project, const RegisterScansOptions& options) {
  options.check();
  ReadyScans scans = ready_scans(project, options);
  RegisterScansResult result;
  result.from_given = starts_from_given(project, options);
  const std::size_t pairs = scans.pairs().size();
  StageProgress progress(options.progress, pairs * (result.from_given ? 2 : 1 + kSearchSteps));
  std::vector<ScanEdge> edges;
  if (result.from_given) {
    edges = edges_from_given(project, scans, options, progress);
  } else {
    add_features(scans, options);
    edges = search_pairs(scans, options, progress);
  }
  const double voxel = finest_voxel(scans);
  ScanNetwork network = join_scans(project, edges, options, kLooseVoxels * voxel);

  result.edges = merged(refined(scans, network, options, progress), edges);
  network = join_scans(project, result.edges, options, kLooseVoxels * voxel);
  // Poses that were given are evidence of their own: scans then may scatter as much as they do.
  const double scatter = result.from_given ? median_rms(result.edges) : 0;
  drop_contradicted(network, scatter, options.num_threads, scans, result.edges);

  RegisterScansOptions plain = options;  // what is wrong was given up by now
  plain.graph.robust = false;
  result.scan_sigma = fitting_scan_sigma(
      project, result.edges, plain, {kTightVoxels * voxel, kLooseVoxels * voxel});
  network = join_scans(project, result.edges, plain, result.scan_sigma);
  move_anchor(
      project, result.from_given ? first_scan(network) : central_scan(scans, network), network);
  refine_jointly(scans, result.edges, options, network);
  result.chi2 = network.chi2;
  result.degrees_of_freedom = network.degrees_of_freedom;
  describe_placements(scans, network, result);
  for (std::size_t i = 0; i < project.scans.size(); ++i) {
    if (!result.scans[i].placed) continue;
    project.scans[i].world_from_scan = *network.world_from_scan[i];
    project.scans[i].pose_covariance = result.scans[i].covariance;
  }
  return result;
}

}  // namespace facula
