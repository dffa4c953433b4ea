// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/line_of_sight.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/filter/plane_of_points.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>

#include <span>

namespace facula {
namespace {

/// The normal of the plane through a point's neighbours, themselves points of `surface`; zero for
/// fewer than three.
Eigen::Vector3f normal_of(const std::vector<Eigen::Vector3f>& surface,
                          std::span<const NearestNeighbours::Neighbour> neighbours,
                          const Eigen::Vector3f& direction) {
  if (neighbours.size() < 3) return Eigen::Vector3f::Zero();
  PlaneOfPoints plane(surface[neighbours.front().index]);
  for (const auto& neighbour : neighbours) plane.add(surface[neighbour.index]);
  return plane.normal_towards(direction);
}

std::vector<Eigen::Vector3f> normals_of_neighbours(const PointCloud& cloud,
                                                   const NearestNeighbours& tree,
                                                   const NormalOptions& options) {
  std::vector<Eigen::Vector3f> normals(cloud.size(), Eigen::Vector3f::Zero());
  const auto estimate = [&](std::size_t i, std::span<const NearestNeighbours::Neighbour> found) {
    normals[i] = normal_of(cloud.points, found, towards_sensor(cloud, i));
  };
  tree.for_all_nearest(options.neighbours, estimate, options.num_threads);
  return normals;
}

/// The same with neighbours from the cloud thinned to `voxel`.
std::vector<Eigen::Vector3f> normals_of_evened(const PointCloud& cloud,
                                               double voxel,
                                               const NormalOptions& options) {
  PointCloud positions;
  positions.points = cloud.points;
  const std::vector<Eigen::Vector3f> surface = thin_by_voxel(positions, voxel).points;
  const NearestNeighbours tree(surface, options.num_threads);
  std::vector<Eigen::Vector3f> normals(cloud.size(), Eigen::Vector3f::Zero());
  const auto estimate = [&](std::size_t begin, std::size_t end) {
    std::vector<NearestNeighbours::Neighbour> buffer(std::size_t(options.neighbours));
    for (std::size_t i = begin; i < end; ++i) {
      const std::span found(buffer.data(), tree.nearest(cloud.points[i], buffer));
      normals[i] = normal_of(surface, found, towards_sensor(cloud, i));
    }
  };
  parallel_for(cloud.size(), estimate, {.num_threads = options.num_threads, .chunk = 1024});
  return normals;
}

}  // namespace

void NormalOptions::check() const {
  require(neighbours >= 3, "neighbours is ", neighbours, "; a plane needs at least 3");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

void estimate_normals(PointCloud& cloud, const NormalOptions& options) {
  options.check();
  cloud.check();
  require(cloud.empty() || cloud.size() >= 3,
          "normals need at least 3 points, the cloud has ",
          cloud.size());
  const NearestNeighbours tree(cloud.points, options.num_threads);
  const double voxel = evening_voxel(cloud, tree);
  cloud.normals = voxel > 0 ? normals_of_evened(cloud, voxel, options)
                            : normals_of_neighbours(cloud, tree, options);
}

}  // namespace facula
