// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

/// Least eigenvector of the covariance of the points at `neighbours`.
Eigen::Vector3d local_normal(const std::vector<Eigen::Vector3f>& points,
                             const std::vector<NearestNeighbours::Neighbour>& neighbours) {
  // About the first neighbour: far from the frame's origin the squares would eat the digits.
  const Eigen::Vector3d base = points[neighbours.front().index].cast<double>();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const auto& neighbour : neighbours) {
    const Eigen::Vector3d d = points[neighbour.index].cast<double>() - base;
    sum += d;
    squares += d * d.transpose();
  }
  const double n = static_cast<double>(neighbours.size());
  const Eigen::Matrix3d scatter = squares - sum * sum.transpose() / n;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvectors().col(0);
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
  const double voxel = evening_voxel(cloud);
  const std::vector<Eigen::Vector3f> surface =
      voxel > 0 ? thin_by_voxel({.points = cloud.points}, voxel).points : cloud.points;
  const NearestNeighbours tree(surface);
  std::vector<Eigen::Vector3f> normals(cloud.size(), Eigen::Vector3f::Zero());
  const auto estimate = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto neighbours = tree.nearest(cloud.points[i], options.neighbours);
      if (neighbours.size() < 3) continue;
      const Eigen::Vector3f normal = local_normal(surface, neighbours).cast<float>();
      const Eigen::Vector3f origin =
          cloud.sensor_origin.empty() ? Eigen::Vector3f::Zero() : cloud.sensor_origin[i];
      normals[i] = normal.dot(origin - cloud.points[i]) < 0 ? Eigen::Vector3f(-normal) : normal;
    }
  };
  parallel_for(cloud.size(), estimate, {.num_threads = options.num_threads, .chunk = 1024});
  cloud.normals = std::move(normals);
}

}  // namespace facula
