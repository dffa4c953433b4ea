// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/point_cloud.hpp>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

// Converters for those who use PCL beside Facula. Only this header and *_pcl.cpp name PCL.

namespace facula {

/// The positions of a cloud, in the same order. is_dense is false when a point is not finite.
inline pcl::PointCloud<pcl::PointXYZ>::Ptr to_pcl(const PointCloud& cloud) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr result(new pcl::PointCloud<pcl::PointXYZ>);
  result->reserve(cloud.size());
  result->is_dense = true;
  for (const Eigen::Vector3f& p : cloud.points) {
    result->push_back(pcl::PointXYZ(p.x(), p.y(), p.z()));
    if (!p.allFinite()) result->is_dense = false;
  }
  return result;
}

/// Positions and normals of a cloud, curvature 0. Throws Error when the cloud has no normals.
inline pcl::PointCloud<pcl::PointNormal>::Ptr to_pcl_with_normals(const PointCloud& cloud) {
  cloud.check();
  require(cloud.empty() || !cloud.normals.empty(),
          "the cloud has no normals; call estimate_normals() first");
  pcl::PointCloud<pcl::PointNormal>::Ptr result(new pcl::PointCloud<pcl::PointNormal>);
  result->reserve(cloud.size());
  result->is_dense = true;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    pcl::PointNormal p;
    p.getVector3fMap() = cloud.points[i];
    p.getNormalVector3fMap() = cloud.normals[i];
    result->push_back(p);
    if (!cloud.points[i].allFinite()) result->is_dense = false;
  }
  return result;
}

/// The positions of a PCL cloud, in the same order, NaN included. An organised cloud loses its
/// rows; a sensor origin other than zero becomes every point's sensor origin.
inline PointCloud from_pcl(const pcl::PointCloud<pcl::PointXYZ>& cloud) {
  PointCloud result;
  result.points.reserve(cloud.size());
  for (const pcl::PointXYZ& p : cloud) result.points.push_back(p.getVector3fMap());
  const Eigen::Vector3f origin = cloud.sensor_origin_.head<3>();
  if (!origin.isZero()) result.sensor_origin.assign(result.size(), origin);
  return result;
}

/// As above, with normals.
inline PointCloud from_pcl(const pcl::PointCloud<pcl::PointNormal>& cloud) {
  PointCloud result;
  result.points.reserve(cloud.size());
  result.normals.reserve(cloud.size());
  for (const pcl::PointNormal& p : cloud) {
    result.points.push_back(p.getVector3fMap());
    result.normals.push_back(p.getNormalVector3fMap());
  }
  const Eigen::Vector3f origin = cloud.sensor_origin_.head<3>();
  if (!origin.isZero()) result.sensor_origin.assign(result.size(), origin);
  return result;
}

}  // namespace facula
