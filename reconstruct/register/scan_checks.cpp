// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/register/scan_checks.hpp>
#include <facula/reconstruct/register/scan_view.hpp>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace facula {
namespace {

constexpr double kMarginVoxels = 3;  // this far before a surface is clearly free [finest voxels]
constexpr double kMostInFreeSpace = 0.2;  // of a scan's points, before another's surface [1]

/// What the views of other scans and their surfaces say about the points of one scan.
struct PointCount {
  std::size_t on_others = 0;  ///< near a point of any other scan
  double greatest_share = 0;  ///< of points in front of what one other scan saw [0..1]
};

PointCount count_points(const ReadyScans& scans,
                        const std::vector<ScanView>& views,
                        const PoseGuesses& world_from_scan,
                        std::size_t i) {
  const PyramidLevel& own = scans.pyramids[i]->levels.back();
  std::vector<bool> met(own.cloud.size());
  PointCount count;
  for (const std::size_t k : scans.order) {
    if (k == i || !world_from_scan[k]) continue;
    const RigidTransform other_from_own = world_from_scan[k]->inverse() * *world_from_scan[i];
    const PyramidLevel& other = scans.pyramids[k]->levels.back();
    const double reach = std::max(own.voxel, other.voxel);
    const double margin = kMarginVoxels * std::max(scans.pyramids[k]->levels.front().voxel,
                                                   scans.pyramids[i]->levels.front().voxel);
    std::size_t free = 0;
    for (std::size_t p = 0; p < own.cloud.size(); ++p) {
      const Eigen::Vector3d x = other_from_own * own.cloud.points[p].cast<double>();
      const auto nearest = other.tree.nearest(x.cast<float>());
      if (std::sqrt(static_cast<double>(nearest.squared_distance)) <= reach) {
        met[p] = true;
      } else if (!views[k].empty() && views[k].at(x, margin) == Seen::kFree) {
        ++free;
      }
    }
    count.greatest_share = std::max(
        count.greatest_share, static_cast<double>(free) / static_cast<double>(own.cloud.size()));
  }
  count.on_others = static_cast<std::size_t>(std::count(met.begin(), met.end(), true));
  return count;
}

std::string percent(double share) {
  std::ostringstream text;
  text << std::lround(100 * share) << " %";
  return text.str();
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

void check_placements(const ReadyScans& scans,
                      const ScanNetwork& network,
                      int num_threads,
                      RegisterScansResult& result) {
  const std::size_t count = network.world_from_scan.size();
  result.anchor = network.anchor;
  result.scans.assign(count, {});
  std::vector<ScanView> views(count);
  for (const std::size_t i : scans.order) {
    const PyramidLevel& level = scans.pyramids[i]->levels.front();
    views[i] = ScanView(level.cloud, level.voxel);
  }
  parallel_for(count,
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   if (!network.world_from_scan[i]) continue;
                   const PointCount points = count_points(scans, views, network.world_from_scan, i);
                   ScanPlacement& place = result.scans[i];
                   place.overlap =
                       static_cast<double>(points.on_others) /
                       static_cast<double>(scans.pyramids[i]->levels.back().cloud.size());
                   place.contradiction = points.greatest_share;
                 }
               },
               {.num_threads = num_threads, .chunk = 1});
  const bool alone = std::count_if(network.world_from_scan.begin(),
                                   network.world_from_scan.end(),
                                   [](const auto& pose) { return pose.has_value(); }) < 2;
  for (std::size_t i = 0; i < count; ++i) {
    ScanPlacement& place = result.scans[i];
    if (!scans.refusals[i].empty()) {
      place.reason = scans.refusals[i];
    } else if (alone || !network.world_from_scan[i]) {
      place.reason = why_refused(result.edges, i);
    } else if (place.contradiction > kMostInFreeSpace && i != network.anchor) {
      place.reason = percent(place.contradiction) +
                     " of its points would stand where another scan looked through";
    } else {
      place.placed = true;
      place.covariance = network.covariance[i];
    }
  }
  for (const ScanEdge& edge : result.edges) {
    if (edge.verdict != EdgeVerdict::kKept) continue;
    for (const std::size_t i : {edge.edge.from, edge.edge.to}) {
      ++result.scans[i].edges;
      result.scans[i].checked = std::max(result.scans[i].checked, edge.residual.redundancy);
    }
  }
  result.placed = static_cast<std::size_t>(
      std::count_if(result.scans.begin(), result.scans.end(), [](const ScanPlacement& scan) {
        return scan.placed;
      }));
}

}  // namespace facula
