// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/polar_scan.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace facula {
namespace {

const Eigen::Vector3f kNoPoint = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());

template <typename T>
void require_length(const std::vector<T>& values, std::size_t expected, const char* name) {
  require(values.size() == expected,
          "the scan's array '",
          name,
          "' has ",
          values.size(),
          " entries where its grid needs ",
          expected);
}

}  // namespace

PolarScan PolarScan::empty(int rows, int cols) {
  require(rows >= 0 && cols >= 0, "a scan needs a size of 0 or more, got ", rows, " x ", cols);
  PolarScan scan;
  scan.rows = rows;
  scan.cols = cols;
  const std::size_t cells = static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
  const std::size_t columns = static_cast<std::size_t>(cols);
  scan.point.assign(cells, kNoPoint);
  scan.range.assign(cells, 0);
  scan.yaw.assign(cells, 0);
  scan.pitch.assign(cells, 0);
  scan.intensity.assign(cells, 0);
  scan.sigma.assign(cells, 0);
  scan.valid.assign(cells, 0);
  scan.axis_position.assign(columns, 0);
  scan.time.assign(columns, 0);
  scan.sensor_origin.assign(columns, Eigen::Vector3d::Zero());
  return scan;
}

void PolarScan::set(std::size_t cell,
                    const Eigen::Vector3d& point_in_scan,
                    float cell_intensity,
                    float cell_sigma) {
  const double distance = point_in_scan.norm();
  point[cell] = point_in_scan.cast<float>();
  range[cell] = static_cast<float>(distance);
  yaw[cell] = static_cast<float>(std::atan2(point_in_scan.y(), point_in_scan.x()));
  pitch[cell] = static_cast<float>(
      std::atan2(point_in_scan.z(), std::hypot(point_in_scan.x(), point_in_scan.y())));
  intensity[cell] = cell_intensity;
  sigma[cell] = cell_sigma;
  valid[cell] = 1;
}

void PolarScan::clear(std::size_t cell) {
  point[cell] = kNoPoint;
  range[cell] = yaw[cell] = pitch[cell] = intensity[cell] = sigma[cell] = 0;
  valid[cell] = 0;
}

std::size_t PolarScan::valid_count() const {
  return static_cast<std::size_t>(std::count(valid.begin(), valid.end(), std::uint8_t{1}));
}

void PolarScan::check() const {
  const std::size_t cells = static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
  const std::size_t columns = static_cast<std::size_t>(cols);
  require_length(point, cells, "point");
  require_length(range, cells, "range");
  require_length(yaw, cells, "yaw");
  require_length(pitch, cells, "pitch");
  require_length(intensity, cells, "intensity");
  require_length(sigma, cells, "sigma");
  require_length(valid, cells, "valid");
  require_length(axis_position, columns, "axis_position");
  require_length(time, columns, "time");
  require_length(sensor_origin, columns, "sensor_origin");
}

}  // namespace facula
