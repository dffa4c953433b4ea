// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/cell_grid.hpp>
#include <facula/map/discretize.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <tuple>

namespace facula {
namespace {

struct Ray {
  CellKey cell;
  std::array<std::uint32_t, 3> origin;  // bit patterns, so that NaN equals itself

  bool operator==(const Ray&) const = default;
  bool operator<(const Ray& other) const {
    return std::tie(cell, origin) < std::tie(other.cell, other.origin);
  }
};

}  // namespace

PointCloud one_ray_per_cell(const PointCloud& cloud, double resolution) {
  std::vector<Ray> rays;
  PointCloud result;
  rays.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto cell = cell_of(cloud.points[i].cast<double>(), resolution);
    const Eigen::Vector3f& origin = cloud.sensor_origin[i];
    if (cell) {
      rays.push_back({*cell,
                      {std::bit_cast<std::uint32_t>(origin.x()),
                       std::bit_cast<std::uint32_t>(origin.y()),
                       std::bit_cast<std::uint32_t>(origin.z())}});
    } else {
      result.points.push_back(Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
      result.sensor_origin.push_back(origin);
    }
  }
  std::sort(rays.begin(), rays.end());
  rays.erase(std::unique(rays.begin(), rays.end()), rays.end());
  for (const Ray& ray : rays) {
    result.points.push_back(centre_of(ray.cell, resolution).cast<float>());
    result.sensor_origin.emplace_back(std::bit_cast<float>(ray.origin[0]),
                                      std::bit_cast<float>(ray.origin[1]),
                                      std::bit_cast<float>(ray.origin[2]));
  }
  return result;
}

}  // namespace facula
