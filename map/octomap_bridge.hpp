// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/map/occupancy_map.hpp>

#include <octomap/OcTree.h>
#include <octomap/Pointcloud.h>

namespace facula {

// For programs that use OctoMap themselves. An OccupancyMap's tree is OccupancyMap::octree(); the
// way back is OccupancyMap::from_octree().

inline octomap::point3d to_octomap(const Eigen::Vector3f& x) {
  return {x.x(), x.y(), x.z()};
}

inline Eigen::Vector3f from_octomap(const octomap::point3d& x) {
  return {x.x(), x.y(), x.z()};
}

/// OctoMap's poses are in float: expect 1e-7 of the distance.
inline octomap::pose6d to_octomap(const RigidTransform& target_from_source) {
  const auto& q = target_from_source.rotation;
  return {to_octomap(Eigen::Vector3f(target_from_source.translation.cast<float>())),
          octomath::Quaternion(static_cast<float>(q.w()),
                               static_cast<float>(q.x()),
                               static_cast<float>(q.y()),
                               static_cast<float>(q.z()))};
}

inline RigidTransform from_octomap(const octomap::pose6d& target_from_source) {
  const octomath::Quaternion& q = target_from_source.rot();
  RigidTransform result;
  result.rotation = Eigen::Quaterniond(static_cast<double>(q.u()),
                                       static_cast<double>(q.x()),
                                       static_cast<double>(q.y()),
                                       static_cast<double>(q.z()))
                        .normalized();
  result.translation = from_octomap(target_from_source.trans()).cast<double>();
  return result;
}

inline octomap::Pointcloud to_octomap(const PointCloud& cloud) {
  octomap::Pointcloud points;
  points.reserve(cloud.size());
  for (const Eigen::Vector3f& x : cloud.points) points.push_back(to_octomap(x));
  return points;
}

/// The points; every one gets the same sensor origin, as an OctoMap scan has one.
inline PointCloud from_octomap(const octomap::Pointcloud& points, const octomap::point3d& origin) {
  PointCloud cloud;
  cloud.points.reserve(points.size());
  for (const octomap::point3d& x : points) cloud.points.push_back(from_octomap(x));
  cloud.sensor_origin.assign(cloud.size(), from_octomap(origin));
  return cloud;
}

}  // namespace facula
