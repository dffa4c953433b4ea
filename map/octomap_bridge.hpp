// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/octree_file.hpp>

#include <memory>
#include <sstream>

#include <octomap/OcTree.h>
#include <octomap/Pointcloud.h>

namespace facula {

// For programs that use OctoMap themselves, and link it.

/// OctoMap's tree with this map's cells and sensor model.
inline std::unique_ptr<octomap::OcTree> to_octomap(const OccupancyMap& map) {
  auto tree = std::make_unique<octomap::OcTree>(map.resolution());
  tree->setProbHit(map.options().hit);
  tree->setProbMiss(map.options().miss);
  tree->setClampingThresMin(map.options().clamp_min);
  tree->setClampingThresMax(map.options().clamp_max);
  if (map.bricks().entries().empty()) return tree;
  std::stringstream bytes;
  write_ot(bytes, map.bricks(), map.resolution());
  std::string line;
  while (line != "data") std::getline(bytes, line);
  tree->readData(bytes);
  return tree;
}

/// A map with this tree's cells, resolution and sensor model. Where the tree holds eight equal
/// leaves (it was filled with lazy_eval and never pruned), the map stands for the pruned tree.
inline OccupancyMap from_octomap(const octomap::OcTree& tree) {
  OccupancyMap map({.resolution = tree.getResolution(),
                    .hit = tree.getProbHit(),
                    .miss = tree.getProbMiss(),
                    .clamp_min = tree.getClampingThresMin(),
                    .clamp_max = tree.getClampingThresMax()});
  std::ostringstream bytes;
  tree.write(bytes);
  map.bricks() = parse_octree(bytes.str(), map.options().model(), "OcTree").map;
  return map;
}

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
