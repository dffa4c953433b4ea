// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/grid_normals.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>
#include <facula/reconstruct/register/scan_pyramid.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

constexpr std::size_t kMinPoints = 12;
constexpr double kLeastSampling = 1e-5;  // of the diameter; nearer points are one point twice
constexpr double kVoxelPerSampling = 2;  // some two points share a voxel: noise is averaged

/// The scan's finite points, with the normals its grid gives where it brings none of its own.
PointCloud finite_points(const PosedCloud& scan, int num_threads) {
  std::vector<std::size_t> finite;
  for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
    if (scan.cloud.points[i].allFinite()) finite.push_back(i);
  }
  require(finite.size() >= kMinPoints,
          "scan '",
          scan.name,
          "' has ",
          finite.size(),
          " finite points; registration needs at least ",
          kMinPoints);
  if (!scan.cloud.normals.empty() || scan.grid.empty()) return selected(scan.cloud, finite);
  PointCloud cloud = scan.cloud;
  cloud.normals = grid_normals(cloud, scan.grid, {.num_threads = num_threads});
  return selected(cloud, finite);
}

/// Throws when the points lie on one line (or in one spot), which shows no surface.
void require_surface(const PointCloud& cloud, const std::string& name) {
  const Eigen::Vector3d centroid = middle_of(cloud);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& p : cloud.points) {
    const Eigen::Vector3d d = p.cast<double>() - centroid;
    scatter += d * d.transpose();
  }
  const Eigen::Vector3d spread =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  require(spread(1) > 1e-8 * spread(2),
          "the points of scan '",
          name,
          "' lie on one line or in one spot; registration needs a surface");
}

double diagonal(const PointCloud& cloud) {
  Eigen::Array3f low = cloud.points.front().array();
  Eigen::Array3f high = low;
  for (const Eigen::Vector3f& p : cloud.points) {
    low = low.min(p.array());
    high = high.max(p.array());
  }
  return static_cast<double>((high - low).matrix().norm());
}

/// A voxel that the scan fills: by the coarser of its two sampling distances. Where most points are
/// duplicates, those of the distinct points count.
double voxel_of(const PointCloud& cloud, double diameter) {
  const auto coarser = [](const PointCloud& points) {
    const SamplingDistance sampling = sampling_distance(points);
    return std::max(sampling.nearest, sampling.across);
  };
  const double least = kLeastSampling * diameter;
  const double sampling = coarser(cloud);
  if (sampling > least) return kVoxelPerSampling * sampling;
  return kVoxelPerSampling * std::max(least, coarser(thin_by_voxel(cloud, least)));
}

/// Thins the cloud; `merged` says how many scan points each of its points stands for, before and
/// after. Sigmas of 1 carry the numbers through the thinning: n of them make a mean of 1 / sqrt(n).
PointCloud thinned(const PointCloud& cloud, double voxel, std::vector<float>& merged) {
  PointCloud counted;
  counted.points = cloud.points;
  for (const float n : merged) counted.sigma.push_back(1 / std::sqrt(n));
  counted = thin_by_voxel(counted, voxel);
  merged.clear();
  for (const float sigma : counted.sigma) merged.push_back(1 / (sigma * sigma));
  return thin_by_voxel(cloud, voxel);
}

}  // namespace

void PyramidOptions::check() const {
  require(finest_voxel >= 0 && std::isfinite(finest_voxel),
          "finest_voxel is ",
          finest_voxel,
          " m; give a length above 0, or 0 to take it from the scan");
  require(levels >= 1 && levels <= 8, "levels is ", levels, "; give 1 to 8");
  require(normal_neighbours >= 3,
          "normal_neighbours is ",
          normal_neighbours,
          "; a plane needs at least 3");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

ScanPyramid build_pyramid(const PosedCloud& scan, const PyramidOptions& options) {
  options.check();
  scan.cloud.check();
  PointCloud cloud = finite_points(scan, options.num_threads);
  require_surface(cloud, scan.name);
  ScanPyramid pyramid;
  pyramid.name = scan.name;
  pyramid.oriented = !cloud.sensor_origin.empty();
  pyramid.diameter = diagonal(cloud);
  double voxel =
      options.finest_voxel > 0 ? options.finest_voxel : voxel_of(cloud, pyramid.diameter);
  const bool own_normals = !cloud.normals.empty();
  std::vector<float> merged(cloud.size(), 1.0F);
  for (int level = 0; level < options.levels; ++level, voxel *= 2) {
    cloud = thinned(cloud, voxel, merged);
    if (level > 0 && cloud.size() < kMinPoints) break;
    require(cloud.size() >= kMinPoints,
            "scan '",
            scan.name,
            "' has only ",
            cloud.size(),
            " points left at a voxel of ",
            voxel,
            " m; choose a smaller voxel");
    if (!own_normals) {
      estimate_normals(
          cloud, {.neighbours = options.normal_neighbours, .num_threads = options.num_threads});
    }
    NearestNeighbours tree(cloud.points);
    pyramid.levels.push_back({voxel, cloud, std::move(tree), merged});
  }
  return pyramid;
}

Eigen::Vector3d middle_of(const PointCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : cloud.points) sum += p.cast<double>();
  return sum / static_cast<double>(cloud.size());
}

const PyramidLevel& coarsest_level(const ScanPyramid& scan, std::size_t least_points) {
  require(!scan.levels.empty(), "the scan ", scan.name, " has no levels; use build_pyramid()");
  std::size_t level = scan.levels.size() - 1;
  while (level > 0 && scan.levels[level].cloud.size() < least_points) --level;
  return scan.levels[level];
}

}  // namespace facula
