// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/measure/plane_relations.hpp>
#include <facula/reconstruct/measure/tilt_zero.hpp>
#include <facula/reconstruct/register/pan_tilt_list.hpp>
#include <facula/tests/reconstruct/corner_series.hpp>

#include <cmath>
#include <numeric>
#include <string>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

const std::vector<std::string> kScans = {"210716-1531-LiDAR-90-Moderate",
                                         "210716-1613-LiDAR-90-Moderate",
                                         "210716-1632-LiDAR-90-Moderate",
                                         "210716-1658-LiDAR-90-Moderate",
                                         "210716-1718-LiDAR-90-Fine",
                                         "210718-2226-LiDAR-90-Fine"};

/// The largest plane that looks along `axis`.
PlaneFit plane_along(const std::vector<ExtractedPlane>& planes,
                     const Eigen::Vector3d& axis,
                     const std::string& scan) {
  for (const ExtractedPlane& plane : planes) {
    if (plane.fit.plane.normal.dot(axis) > 0.95) return plane.fit;
  }
  fail("the corner's scan ", scan, " lacks a plane");
}

}  // namespace

double Series::mean() const {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double Series::spread() const {
  double squares = 0;
  for (const double v : values) squares += (v - mean()) * (v - mean());
  return std::sqrt(squares / double(values.size() - 1));
}

CornerSeries corner_series(const std::filesystem::path& folder, double tilt_zero) {
  CornerSeries corner;
  for (const std::string& name : kScans) {
    PointCloud cloud = posed_cloud(read_pan_tilt_list(folder / (name + ".csv")), tilt_zero).cloud;
    estimate_normals(cloud);
    const auto planes = extract_planes(cloud, {.inlier_distance = 0.015, .min_points = 100});
    const PlaneFit a = plane_along(planes, Eigen::Vector3d::UnitX(), name);
    const PlaneFit b = plane_along(planes, Eigen::Vector3d::UnitY(), name);
    const PlaneFit c = plane_along(planes, Eigen::Vector3d::UnitZ(), name);
    corner.ab.values.push_back(180 - measured_corner(a, b).value / kDegree);
    corner.ac.values.push_back(180 - measured_corner(a, c).value / kDegree);
    corner.bc.values.push_back(180 - measured_corner(b, c).value / kDegree);
    corner.a.values.push_back(1000 * a.plane.distance);
    corner.b.values.push_back(1000 * b.plane.distance);
    corner.c.values.push_back(1000 * c.plane.distance);
  }
  return corner;
}

TiltZeroSeries tilt_zero_series(const std::filesystem::path& folder) {
  TiltZeroSeries series;
  std::vector<std::string> scans = kScans;
  scans.emplace_back("210718-2325-LiDAR-180-Fine");
  for (const std::string& name : scans) {
    const PanTiltList list = read_pan_tilt_list(folder / (name + ".csv"));
    const TiltZero found = find_tilt_zero(sweeps_of(list).rising);
    series.zero.values.push_back(found.tilt_zero.value / kDegree);
    series.on_planes.values.push_back(found.on_planes);
  }
  return series;
}

}  // namespace facula
