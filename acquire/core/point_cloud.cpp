// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/point_cloud.hpp>

namespace facula {
namespace {

template <typename T>
void require_length(const std::vector<T>& values, std::size_t expected, const char* name) {
  require(values.empty() || values.size() == expected,
          "the cloud's ",
          name,
          " have ",
          values.size(),
          " entries where its points have ",
          expected);
}

template <typename T>
std::vector<T> selected(const std::vector<T>& values, const std::vector<std::size_t>& indices) {
  std::vector<T> result;
  if (values.empty()) return result;
  result.reserve(indices.size());
  for (const std::size_t i : indices) result.push_back(values[i]);
  return result;
}

template <typename T>
void append(std::vector<T>& values, const std::vector<T>& more, bool keep) {
  if (keep) {
    values.insert(values.end(), more.begin(), more.end());
  } else {
    values.clear();
  }
}

}  // namespace

void PointCloud::check() const {
  require_length(normals, size(), "normals");
  require_length(colors, size(), "colours");
  require_length(intensity, size(), "intensities");
  require_length(sigma, size(), "sigmas");
  require_length(sensor_origin, size(), "sensor origins");
}

PointCloud transformed(const PointCloud& cloud, const RigidTransform& target_from_source) {
  PointCloud result = cloud;
  for (auto& p : result.points) p = (target_from_source * p.cast<double>()).cast<float>();
  for (auto& o : result.sensor_origin) o = (target_from_source * o.cast<double>()).cast<float>();
  for (auto& n : result.normals) n = target_from_source.rotation.cast<float>() * n;
  return result;
}

PointCloud selected(const PointCloud& cloud, const std::vector<std::size_t>& indices) {
  PointCloud result;
  result.points = selected(cloud.points, indices);
  result.normals = selected(cloud.normals, indices);
  result.colors = selected(cloud.colors, indices);
  result.intensity = selected(cloud.intensity, indices);
  result.sigma = selected(cloud.sigma, indices);
  result.sensor_origin = selected(cloud.sensor_origin, indices);
  return result;
}

void append(PointCloud& cloud, const PointCloud& more) {
  if (more.empty()) return;
  if (cloud.empty()) {
    cloud = more;
    return;
  }
  const std::size_t before = cloud.size();
  const auto both = [&](const auto& a, const auto& b) {
    return a.size() == before && b.size() == more.size();
  };
  append(cloud.normals, more.normals, both(cloud.normals, more.normals));
  append(cloud.colors, more.colors, both(cloud.colors, more.colors));
  append(cloud.intensity, more.intensity, both(cloud.intensity, more.intensity));
  append(cloud.sigma, more.sigma, both(cloud.sigma, more.sigma));
  append(cloud.sensor_origin, more.sensor_origin, both(cloud.sensor_origin, more.sensor_origin));
  append(cloud.points, more.points, true);
}

PointCloud cloud_from_scan(const PolarScan& scan, std::vector<std::size_t>* cells) {
  scan.check();
  PointCloud cloud;
  if (cells != nullptr) cells->clear();
  for (int col = 0; col < scan.cols; ++col) {
    const Eigen::Vector3f origin = scan.sensor_origin[static_cast<std::size_t>(col)].cast<float>();
    for (int row = 0; row < scan.rows; ++row) {
      const std::size_t cell = scan.index(row, col);
      if (scan.valid[cell] == 0) continue;
      cloud.points.push_back(scan.point[cell]);
      cloud.intensity.push_back(scan.intensity[cell]);
      cloud.sigma.push_back(scan.sigma[cell]);
      cloud.sensor_origin.push_back(origin);
      if (cells != nullptr) cells->push_back(cell);
    }
  }
  return cloud;
}

}  // namespace facula
