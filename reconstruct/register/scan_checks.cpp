// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/register/pose_score.hpp>
#include <facula/reconstruct/register/scan_checks.hpp>
#include <facula/reconstruct/register/scan_view.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace facula {
namespace {

// True poses of the bunny's and a furnished room's scans stay below 0.38 and at 0; poses of scans
// that show something else reach 0.5 and more.
constexpr double kMostDoubt = 0.45;          // misfit plus twice the contradiction [1]
constexpr double kMostContradiction = 0.05;  // whatever the misfit [1]
constexpr double kMostIfKnown = 2.0 / 3;     // of either, where the poses were given [1]
constexpr double kTellingOverlap = 0.1;      // misfit of scans that share less tells nothing [1]

using Pair = std::pair<std::size_t, std::size_t>;

/// What two placed scans say about each other.
struct PairCheck {
  Pair scans;
  PoseScore score;

  /// `known`: the poses were given, which is evidence of its own; bent and tilted scanners make
  /// scans that are neighbours for certain stand off each other, so only a plain contradiction
  /// counts.
  bool fails(bool known) const {
    if (known) return score.contradiction > kMostIfKnown || score.misfit > kMostIfKnown;
    const double doubt = score.misfit + 2 * score.contradiction;
    return score.contradiction > kMostContradiction ||
           (score.overlap >= kTellingOverlap && doubt > kMostDoubt);
  }
};

std::vector<PairCheck> check_pairs(const ReadyScans& scans,
                                   const std::vector<ScanView>& views,
                                   const PoseGuesses& world_from_scan,
                                   const PoseScoreOptions& how) {
  std::vector<PairCheck> checks;
  for (const Pair& pair : scans.pairs()) {
    if (world_from_scan[pair.first] && world_from_scan[pair.second]) checks.push_back({pair, {}});
  }
  parallel_for(checks.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t c = begin; c < end; ++c) {
                   const auto [a, b] = checks[c].scans;
                   checks[c].score = score_pose({*scans.pyramids[a], views[a]},
                                                {*scans.pyramids[b], views[b]},
                                                world_from_scan[b]->inverse() * *world_from_scan[a],
                                                {.scatter = how.scatter, .num_threads = 1});
                 }
               },
               {.num_threads = how.num_threads, .chunk = 1});
  return checks;
}

/// Scans to give up so that no two that stay contradict each other: the one with the most failed
/// pairs goes first, of equal ones the one that shares less with the others. The scans' first
/// failed pairs are kept as reasons.
std::vector<const PairCheck*> misfits(const std::vector<PairCheck>& checks,
                                      std::size_t count,
                                      bool known) {
  std::vector<const PairCheck*> given_up(count, nullptr);
  std::vector<double> shared(count);
  for (const PairCheck& check : checks) {
    shared[check.scans.first] += check.score.overlap;
    shared[check.scans.second] += check.score.overlap;
  }
  for (;;) {
    std::vector<std::size_t> failed(count);
    std::vector<const PairCheck*> why(count, nullptr);
    for (const PairCheck& check : checks) {
      const auto [a, b] = check.scans;
      if (given_up[a] != nullptr || given_up[b] != nullptr || !check.fails(known)) continue;
      for (const std::size_t i : {a, b}) {
        ++failed[i];
        if (why[i] == nullptr) why[i] = &check;
      }
    }
    std::size_t worst = 0;
    for (std::size_t i = 1; i < count; ++i) {
      if (failed[i] > failed[worst] || (failed[i] == failed[worst] && shared[i] < shared[worst])) {
        worst = i;
      }
    }
    if (failed[worst] == 0) return given_up;
    given_up[worst] = why[worst];
  }
}

/// Share of the scan's points that lie on any other placed scan.
double share_on_others(const ReadyScans& scans, const PoseGuesses& world_from_scan, std::size_t i) {
  const PyramidLevel& own = scans.pyramids[i]->levels.back();
  std::vector<bool> met(own.cloud.size());
  for (const std::size_t k : scans.order) {
    if (k == i || !world_from_scan[k]) continue;
    const RigidTransform other_from_own = world_from_scan[k]->inverse() * *world_from_scan[i];
    const PyramidLevel& other = scans.pyramids[k]->levels.back();
    const double reach = std::max(own.voxel, other.voxel);
    for (std::size_t p = 0; p < own.cloud.size(); ++p) {
      const Eigen::Vector3d x = other_from_own * own.cloud.points[p].cast<double>();
      const auto nearest = other.tree.nearest(x.cast<float>());
      if (static_cast<double>(nearest.squared_distance) <= reach * reach) met[p] = true;
    }
  }
  return static_cast<double>(std::count(met.begin(), met.end(), true)) /
         static_cast<double>(own.cloud.size());
}

std::string percent(double share) {
  std::ostringstream text;
  text << std::lround(100 * share) << " %";
  return text.str();
}

std::string sentence(const PairCheck& check) {
  return "at the best pose found " + percent(check.score.contradiction) +
         " of its points stand where another scan looked through and " +
         percent(check.score.misfit) + " lie near that scan but not on it";
}

std::vector<ScanView> views_of(const ReadyScans& scans, int num_threads) {
  std::vector<ScanView> views(scans.pyramids.size());
  parallel_for(scans.order.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k) {
                   const std::size_t i = scans.order[k];
                   const PyramidLevel& level = scans.pyramids[i]->levels.front();
                   views[i] = ScanView(level.cloud, level.voxel);
                 }
               },
               {.num_threads = num_threads, .chunk = 1});
  return views;
}

/// Why a scan without a place has none.
std::string why_refused(const std::vector<ScanEdge>& edges, std::size_t scan) {
  const ScanEdge* best = nullptr;
  for (const ScanEdge& edge : edges) {
    if (edge.edge.from != scan && edge.edge.to != scan) continue;
    if (edge.verdict == EdgeVerdict::kKept) {
      return "it is joined with others, but not with the scan that stays";
    }
    if (best == nullptr || edge.overlap > best->overlap) best = &edge;
  }
  if (best == nullptr) return "it overlaps no other scan by the poses given";
  return "no other scan holds it: with the best, " + best->reason;
}

}  // namespace

void drop_contradicted(const ScanNetwork& network,
                       double scatter,
                       int num_threads,
                       ReadyScans& scans,
                       std::vector<ScanEdge>& edges) {
  const std::vector<PairCheck> checks =
      check_pairs(scans,
                  views_of(scans, num_threads),
                  network.world_from_scan,
                  {.scatter = scatter, .num_threads = num_threads});
  const std::vector<const PairCheck*> given_up =
      misfits(checks, network.world_from_scan.size(), scatter > 0);
  for (std::size_t i = 0; i < given_up.size(); ++i) {
    if (given_up[i] != nullptr) scans.refusals[i] = sentence(*given_up[i]);
  }
  for (ScanEdge& edge : edges) {
    if (edge.verdict != EdgeVerdict::kKept) continue;
    if (given_up[edge.edge.from] == nullptr && given_up[edge.edge.to] == nullptr) continue;
    edge.verdict = EdgeVerdict::kRefused;
    edge.reason = "the scan contradicts others there";
  }
}

void describe_placements(const ReadyScans& scans,
                         const ScanNetwork& network,
                         RegisterScansResult& result) {
  const std::size_t count = network.world_from_scan.size();
  result.anchor = network.anchor;
  result.scans.assign(count, {});
  const bool alone = std::count_if(network.world_from_scan.begin(),
                                   network.world_from_scan.end(),
                                   [](const auto& pose) { return pose.has_value(); }) < 2;
  for (std::size_t i = 0; i < count; ++i) {
    ScanPlacement& place = result.scans[i];
    if (!scans.refusals[i].empty()) {
      place.reason = scans.refusals[i];
    } else if (alone || !network.world_from_scan[i]) {
      place.reason = why_refused(result.edges, i);
    } else {
      place.placed = true;
      place.covariance = network.covariance[i];
      place.overlap = share_on_others(scans, network.world_from_scan, i);
      ++result.placed;
    }
  }
  for (const ScanEdge& edge : result.edges) {
    if (edge.verdict != EdgeVerdict::kKept) continue;
    for (const std::size_t i : {edge.edge.from, edge.edge.to}) {
      ++result.scans[i].edges;
      result.scans[i].checked = std::max(result.scans[i].checked, edge.residual.redundancy);
    }
  }
}

}  // namespace facula
