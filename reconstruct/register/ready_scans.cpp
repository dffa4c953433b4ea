// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/register/ready_scans.hpp>

#include <algorithm>
#include <tuple>

namespace facula {
namespace {

/// The name of the first scan that holds the very same points, if any.
std::string twin_of(const ScanProject& project, std::size_t i) {
  for (std::size_t k = 0; k < i; ++k) {
    if (project.scans[k].cloud.points == project.scans[i].cloud.points) {
      return project.scans[k].name;
    }
  }
  return {};
}

void build_one(const ScanProject& project,
               std::size_t i,
               const PyramidOptions& options,
               ReadyScans& scans) {
  const PosedCloud& scan = project.scans[i];
  if (scan.cloud.empty()) {
    scans.refusals[i] = "it has no points";
    return;
  }
  const std::string twin = twin_of(project, i);
  if (!twin.empty()) {
    scans.refusals[i] = "it holds the same points as scan '" + twin + "', named before it";
    return;
  }
  try {
    scans.pyramids[i] = build_pyramid(scan, options);
  } catch (const Error& error) {
    scans.refusals[i] = error.what();
  }
}

/// Calls body(k) for every k below `count`, some at once. The work of one call stays in one thread.
template <typename Body>
void for_each_scan(std::size_t count, int num_threads, const Body& body) {
  parallel_for(count,
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t k = begin; k < end; ++k) body(k);
               },
               {.num_threads = num_threads, .chunk = 1});
}

double share_near(const PyramidLevel& a,
                  const PyramidLevel& b,
                  const RigidTransform& b_from_a,
                  double distance) {
  std::size_t near = 0;
  for (const Eigen::Vector3f& p : a.cloud.points) {
    const Eigen::Vector3d x = b_from_a * p.cast<double>();
    const auto nearest = b.tree.nearest(x.cast<float>());
    if (static_cast<double>(nearest.squared_distance) <= distance * distance) ++near;
  }
  return static_cast<double>(near) / static_cast<double>(a.cloud.size());
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> ReadyScans::pairs() const {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t b = 1; b < order.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) pairs.emplace_back(order[b], order[a]);
  }
  return pairs;
}

ReadyScans ready_scans(const ScanProject& project, const RegisterScansOptions& options) {
  const std::size_t count = project.scans.size();
  require(count >= 2, "expected two scans or more, got ", count, "; name another scan");
  ReadyScans scans;
  scans.pyramids.resize(count);
  scans.features.resize(count);
  scans.refusals.resize(count);
  PyramidOptions alone = options.pyramid;
  alone.num_threads = 1;
  for_each_scan(
      count, options.num_threads, [&](std::size_t i) { build_one(project, i, alone, scans); });
  for (std::size_t i = 0; i < count; ++i) {
    if (scans.pyramids[i]) scans.order.push_back(i);
  }
  std::sort(scans.order.begin(), scans.order.end(), [&](std::size_t a, std::size_t b) {
    return std::tie(project.scans[a].name, a) < std::tie(project.scans[b].name, b);
  });
  for (std::size_t i = 0; i < count && scans.order.size() < 2; ++i) {
    require(scans.refusals[i].empty(),
            "fewer than two of ",
            count,
            " scans can be registered; of scan '",
            project.scans[i].name,
            "': ",
            scans.refusals[i]);
  }
  return scans;
}

void add_features(ReadyScans& scans, const RegisterScansOptions& options) {
  std::vector<const ScanPyramid*> pyramids;
  for (const std::size_t i : scans.order) pyramids.push_back(&*scans.pyramids[i]);
  const GlobalFeatureOptions how{.voxel = feature_voxel(pyramids), .num_threads = 1};
  for_each_scan(scans.order.size(), options.num_threads, [&](std::size_t k) {
    const std::size_t i = scans.order[k];
    try {
      scans.features[i] = find_global_features(*scans.pyramids[i], how);
    } catch (const Error& error) {
      scans.refusals[i] = error.what();
    }
  });
  std::erase_if(scans.order, [&](std::size_t i) { return !scans.features[i]; });
  require(scans.order.size() >= 2,
          "fewer than two scans show enough surface to be found without a guess; give rough poses");
}

double rough_overlap(const ScanPyramid& source,
                     const ScanPyramid& target,
                     const RigidTransform& target_from_source,
                     double distance) {
  const PyramidLevel& a = source.levels.back();
  const PyramidLevel& b = target.levels.back();
  return std::max(share_near(a, b, target_from_source, distance),
                  share_near(b, a, target_from_source.inverse(), distance));
}

}  // namespace facula
