// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/distinct_points.hpp>
#include <facula/reconstruct/filter/line_of_sight.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/filter/plane_of_points.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>

#include <algorithm>
#include <atomic>
#include <optional>
#include <span>
#include <utility>

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

/// More than the point itself stands where it does.
bool has_double(std::span<const NearestNeighbours::Neighbour> neighbours) {
  return std::count_if(neighbours.begin(), neighbours.end(), [](const auto& n) {
           return n.squared_distance == 0;
         }) > 1;
}

/// Nothing where points stand in one place: those would be all the neighbours of each other.
std::optional<std::vector<Eigen::Vector3f>> normals_of_neighbours(const PointCloud& cloud,
                                                                  const NearestNeighbours& tree,
                                                                  const NormalOptions& options) {
  std::vector<Eigen::Vector3f> normals(cloud.size(), Eigen::Vector3f::Zero());
  std::atomic<bool> doubles = false;
  const auto estimate = [&](std::size_t i, std::span<const NearestNeighbours::Neighbour> found) {
    normals[i] = normal_of(cloud.points, found, towards_sensor(cloud, i));
    if (has_double(found)) doubles.store(true, std::memory_order_relaxed);
  };
  tree.for_all_nearest(options.neighbours, estimate, options.num_threads);
  if (doubles) return std::nullopt;
  return normals;
}

std::vector<Eigen::Vector3f> thinned_points(const PointCloud& cloud, double voxel) {
  PointCloud positions;
  positions.points = cloud.points;
  return thin_by_voxel(positions, voxel).points;
}

std::vector<Eigen::Vector3f> points_apart(const PointCloud& cloud) {
  std::vector<Eigen::Vector3f> apart;
  for (const std::size_t i : distinct_points(cloud.points)) apart.push_back(cloud.points[i]);
  return apart;
}

/// The same with neighbours from other points of the cloud's surface.
std::vector<Eigen::Vector3f> normals_of_surface(const PointCloud& cloud,
                                                const std::vector<Eigen::Vector3f>& surface,
                                                const NormalOptions& options) {
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
  if (voxel > 0) {
    cloud.normals = normals_of_surface(cloud, thinned_points(cloud, voxel), options);
    return;
  }
  auto normals = normals_of_neighbours(cloud, tree, options);
  cloud.normals =
      normals ? std::move(*normals) : normals_of_surface(cloud, points_apart(cloud), options);
}

}  // namespace facula
