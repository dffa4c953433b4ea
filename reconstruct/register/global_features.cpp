// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/register/global_features.hpp>
#include <facula/reconstruct/register/plane_triples.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr std::size_t kPoints = 2000;      // wanted of a scan [1]
constexpr double kFeatureRadius = 5;       // [voxels]
constexpr double kReach = 3;               // of the lookup of near points [voxels]
constexpr std::size_t kFewestPoints = 12;  // as register_pair() [1]

/// The points thinned to the voxel whose normals are known and agree within it.
PointCloud thinned(const ScanPyramid& scan, double voxel) {
  const PyramidLevel& level = coarsest_level(scan, kPoints);
  PointCloud all = voxel > level.voxel ? thin_by_voxel(level.cloud, voxel) : level.cloud;
  require(!all.normals.empty(), "the scan ", scan.name, " has no normals; use build_pyramid()");
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const float square = all.normals[i].squaredNorm();
    if (all.points[i].allFinite() && square > 0.9F && square < 1.1F) kept.push_back(i);
  }
  return selected(all, kept);
}

std::shared_ptr<const FeatureTree> tree_of(const std::vector<FpfhFeature>& features) {
  std::vector<std::uint32_t> keys;
  for (std::size_t i = 0; i < features.size(); ++i) {
    const bool finite = std::all_of(
        features[i].begin(), features[i].end(), [](float bin) { return std::isfinite(bin); });
    if (finite) keys.push_back(static_cast<std::uint32_t>(i));
  }
  return std::make_shared<const FeatureTree>(features, keys);
}

}  // namespace

void GlobalFeatureOptions::check() const {
  require(voxel >= 0 && std::isfinite(voxel),
          "voxel is ",
          voxel,
          " m; give a length above 0, or 0 to have it chosen");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

double feature_voxel(const std::vector<const ScanPyramid*>& scans) {
  double voxel = 0;
  for (const ScanPyramid* scan : scans) {
    require(scan != nullptr, "a scan is missing (null); give pyramids of build_pyramid()");
    const PyramidLevel& level = coarsest_level(*scan, kPoints);
    const double many = static_cast<double>(level.cloud.size()) / static_cast<double>(kPoints);
    // The points of a surface fall with the square of the voxel.
    voxel = std::max(voxel, level.voxel * std::sqrt(std::max(1.0, many)));
  }
  return voxel;
}

GlobalFeatures find_global_features(const ScanPyramid& scan, const GlobalFeatureOptions& options) {
  options.check();
  GlobalFeatures result;
  result.scan = &scan;
  result.voxel = options.voxel > 0 ? options.voxel : feature_voxel({&scan});
  result.cloud = thinned(scan, result.voxel);
  require(result.cloud.size() >= kFewestPoints,
          "the scan ",
          scan.name,
          " has ",
          result.cloud.size(),
          " points with normals at ",
          result.voxel,
          " m from each other; registration needs at least ",
          kFewestPoints);
  result.near = NearestGrid(result.cloud.points, result.voxel / 2, kReach * result.voxel);
  result.features = fpfh_features(
      result.cloud, {.radius = kFeatureRadius * result.voxel, .num_threads = options.num_threads});
  result.tree = tree_of(result.features);
  if (options.planes) result.planes = room_planes(scan, options.num_threads);
  const PyramidLevel& finest = scan.levels.front();
  result.view = ScanView(finest.cloud, finest.voxel);
  return result;
}

}  // namespace facula
