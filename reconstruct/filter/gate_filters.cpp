// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/gate_filters.hpp>
#include <facula/reconstruct/filter/line_of_sight.hpp>

#include <cmath>
#include <numbers>

namespace facula {

void RangeGate::check() const {
  require(nearest >= 0 && std::isfinite(nearest),
          "nearest is ",
          nearest,
          " m; give a length of 0 or more");
  require(farthest > nearest,
          "farthest is ",
          farthest,
          " m; give more than the nearest range, ",
          nearest,
          " m");
}

FilterVerdict outside_range(const PointCloud& cloud, const RangeGate& gate) {
  gate.check();
  cloud.check();
  FilterVerdict verdict(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) verdict.remove(i, Removal::kNotFinite);
    const double range = towards_sensor(cloud, i).norm();
    if (range < gate.nearest || range > gate.farthest) verdict.remove(i, Removal::kRange);
  }
  return verdict;
}

void HeightGate::check() const {
  require(highest > lowest,
          "the highest level is ",
          highest,
          " m; give more than the lowest, ",
          lowest,
          " m");
}

FilterVerdict outside_height(const PointCloud& cloud,
                             const HeightGate& gate,
                             const RigidTransform& world_from_cloud) {
  gate.check();
  cloud.check();
  FilterVerdict verdict(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) verdict.remove(i, Removal::kNotFinite);
    const double height = (world_from_cloud * cloud.points[i].cast<double>()).z();
    if (height < gate.lowest || height > gate.highest) verdict.remove(i, Removal::kRange);
  }
  return verdict;
}

FilterVerdict steeper_than(const PointCloud& cloud, double max_incidence) {
  cloud.check();
  require(max_incidence > 0 && max_incidence <= std::numbers::pi / 2,
          "the incidence gate is ",
          max_incidence,
          " rad; give an angle above 0 and at most pi/2");
  require(cloud.empty() || !cloud.normals.empty(),
          "an incidence gate needs normals and the cloud has none; estimate them first");
  FilterVerdict verdict(cloud.size());
  const double least = std::cos(max_incidence);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.points[i].allFinite()) verdict.remove(i, Removal::kNotFinite);
    const Eigen::Vector3f& normal = cloud.normals[i];
    const double cosine = normal.dot(towards_sensor(cloud, i).stableNormalized());
    if (!normal.isZero() && cosine < least) verdict.remove(i, Removal::kIncidence);
  }
  return verdict;
}

}  // namespace facula
