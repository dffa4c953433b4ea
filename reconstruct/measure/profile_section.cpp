// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/measure/profile_section.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

namespace facula {

void SectionOptions::check() const {
  require(point.allFinite(), "expected a finite point of the section");
  require(thickness > 0 && std::isfinite(thickness),
          "expected a slice thicker than 0 mm, got ",
          1000 * thickness);
  require(normal.allFinite() && up.allFinite() &&
              normal.cross(up).norm() > 1e-6 * normal.norm() * up.norm(),
          "expected a normal and an upward direction that are not parallel, got (",
          normal.transpose(),
          ") and (",
          up.transpose(),
          ")");
}

ProfileSection cut_section(const PointCloud& cloud, const SectionOptions& options) {
  options.check();
  cloud.check();
  const Eigen::Vector3d normal = options.normal.normalized();
  const Eigen::Vector3d up = (options.up - options.up.dot(normal) * normal).normalized();
  const Eigen::Vector3d across = up.cross(normal);
  std::vector<Eigen::Vector2d> points;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d d = cloud.points[i].cast<double>() - options.point;
    if (!(std::abs(d.dot(normal)) <= options.thickness / 2)) continue;
    points.emplace_back(d.dot(across), d.dot(up));
    indices.push_back(i);
  }
  require(!points.empty(),
          "expected points within ",
          500 * options.thickness,
          " mm of the section, got none of ",
          cloud.size(),
          "; move the section or make the slice thicker");
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].x() < points[b].x();
  });
  ProfileSection section;
  for (const std::size_t i : order) {
    section.points.push_back(points[i]);
    section.indices.push_back(indices[i]);
    if (!cloud.sigma.empty()) section.sigma.push_back(cloud.sigma[indices[i]]);
  }
  return section;
}

}  // namespace facula
