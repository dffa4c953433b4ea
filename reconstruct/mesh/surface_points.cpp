// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/distinct_points.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>
#include <facula/reconstruct/mesh/mesh_engines.hpp>
#include <facula/reconstruct/mesh/orient_mesh.hpp>

#include <algorithm>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

constexpr float kFarthest = 1e9F;  // engines divide by zero where products of coordinates overflow

void require_near(const std::vector<Eigen::Vector3f>& points) {
  float farthest = 0;
  for (const Eigen::Vector3f& p : points) farthest = std::max(farthest, p.cwiseAbs().maxCoeff());
  require(farthest < kFarthest,
          "a point stands ",
          farthest,
          " m from the world's origin, where no scanner reaches; remove it, or check the unit of "
          "the file");
}

/// Engines print and give up, or loop, where the points span no plane.
void require_wide(const std::vector<Eigen::Vector3f>& points) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : points) sum += p.cast<double>();
  const Eigen::Vector3d centroid = sum / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3d d = p.cast<double>() - centroid;
    scatter += d * d.transpose();
  }
  const Eigen::Vector3d spread =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  require(spread(1) > 1e-12 * spread(2),
          "the ",
          points.size(),
          " points lie on one line or in one spot, so they hold no surface");
}

Eigen::Vector3f outward_at(const PointCloud& cloud, std::size_t point) {
  if (cloud.sensor_origin.empty()) return cloud.normals[point];
  return cloud.sensor_origin[point] - cloud.points[point];
}

}  // namespace

PointCloud surface_points(const PointCloud& cloud) {
  cloud.check();
  const std::vector<std::size_t> distinct = distinct_points(cloud.points);
  require(distinct.size() >= 4,
          "a surface needs at least 4 points, the cloud has ",
          distinct.size(),
          " that are finite and apart");
  PointCloud points = selected(cloud, distinct);
  require_near(points.points);
  require_wide(points.points);
  return points;
}

double reaching_edge(const PointCloud& cloud) {
  const SamplingDistance distance = sampling_distance(cloud);
  return std::max(6 * distance.nearest, 3 * distance.across);
}

void orient_by_points(TriangleMesh& mesh, const PointCloud& cloud) {
  std::vector<Eigen::Vector3f> outward;
  if (!cloud.empty() && (!cloud.sensor_origin.empty() || !cloud.normals.empty())) {
    const NearestNeighbours tree(cloud.points);
    outward.reserve(mesh.vertices.size());
    for (const Eigen::Vector3f& v : mesh.vertices) {
      outward.push_back(outward_at(cloud, tree.nearest(v).index));
    }
  }
  orient_mesh(mesh, outward);
}

}  // namespace facula
