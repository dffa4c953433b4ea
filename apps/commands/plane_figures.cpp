// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/commands/plane_figures.hpp>

#include <array>

namespace facula {
namespace {

constexpr double kParallel = 10 * 0.017453292519943295;  // [rad]

FigureTable plane_table() {
  return {"planes",
          "Planes (normal . x = distance):",
          {{"plane", "plane", 0},
           {"normal_x", "nx", 5},
           {"normal_y", "ny", 5},
           {"normal_z", "nz", 5},
           {"distance_mm", "distance", 2},
           {"points", "points", 0},
           {"rms_mm", "rms", 3},
           {"mean_absolute_mm", "mean", 3},
           {"peak_to_valley_mm", "p2v", 2},
           {"extent_mm", "extent", 0},
           {"width_mm", "width", 0},
           {"area_m2", "area", 3},
           {"four_sigma_over_range_percent", "4 sigma/D", 3},
           {"normal_sigma_deg", "normal sigma", 5},
           {"distance_sigma_mm", "distance sigma", 4}},
          {}};
}

std::vector<FigureValue> plane_row(std::size_t number, const PlaneFit& fit) {
  return {static_cast<long long>(number),
          fit.plane.normal.x(),
          fit.plane.normal.y(),
          fit.plane.normal.z(),
          1000 * fit.plane.distance,
          static_cast<long long>(fit.points),
          1000 * fit.rms,
          1000 * fit.mean_absolute,
          1000 * fit.peak_to_valley,
          1000 * fit.extent,
          1000 * fit.width,
          fit.area,
          100 * fit.system_error,
          fit.normal_sigma / kDegrees.factor,
          1000 * fit.distance_sigma};
}

}  // namespace

void report_planes(const std::vector<ExtractedPlane>& planes,
                   Figures& figures,
                   const RelationOptions& options) {
  FigureTable table = plane_table();
  FigureTable angles{"angles",
                     "Angles between planes:",
                     {{"plane", "plane", 0},
                      {"other", "other", 0},
                      {"angle_deg", "angle", 4},
                      {"angle_sigma_deg", "sigma", 4}},
                     {}};
  FigureTable distances{"distances",
                        "Distances of planes that are parallel to 10 deg:",
                        {{"plane", "plane", 0},
                         {"other", "other", 0},
                         {"distance_mm", "distance", 2},
                         {"distance_sigma_mm", "sigma", 3}},
                        {}};
  for (std::size_t i = 0; i < planes.size(); ++i) {
    table.rows.push_back(plane_row(i + 1, planes[i].fit));
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const Measured angle = measured_angle(planes[i].fit, planes[j].fit, options);
      const auto first = static_cast<long long>(i + 1);
      const auto second = static_cast<long long>(j + 1);
      angles.rows.push_back(
          {first, second, angle.value / kDegrees.factor, angle.sigma / kDegrees.factor});
      if (angle.value > kParallel) continue;
      const Measured apart = measured_distance(planes[i].fit, planes[j].fit, options);
      distances.rows.push_back({first, second, 1000 * apart.value, 1000 * apart.sigma});
    }
  }
  figures.table(std::move(table));
  if (!angles.rows.empty()) figures.table(std::move(angles));
  if (!distances.rows.empty()) figures.table(std::move(distances));
}

void write_planes_csv(const std::filesystem::path& path,
                      const std::vector<ExtractedPlane>& planes) {
  AtomicFile file(path);
  file.stream()
      << "plane,normal_x,normal_y,normal_z,distance_mm,points,rms_mm,mean_absolute_mm,"
         "peak_to_valley_mm,extent_mm,width_mm,mean_range_mm,four_sigma_over_range,"
         "normal_sigma_deg,distance_sigma_mm,centroid_x_mm,centroid_y_mm,centroid_z_mm,area_m2,"
         "axis_u_x,axis_u_y,axis_u_z,axis_v_x,axis_v_y,axis_v_z,cov_uu_rad2,cov_uv_rad2,"
         "cov_vv_rad2,cov_uh_rad_m,cov_vh_rad_m,cov_hh_m2,chi_squared,unexplained_mm\n";
  std::size_t number = 0;
  for (const ExtractedPlane& plane : planes) {
    const PlaneFit& fit = plane.fit;
    const Eigen::Vector3d& n = fit.plane.normal;
    const Eigen::Vector3d c = 1000 * fit.centroid;
    file.stream() << ++number;
    for (const double value : {n.x(),
                               n.y(),
                               n.z(),
                               1000 * fit.plane.distance,
                               static_cast<double>(fit.points),
                               1000 * fit.rms,
                               1000 * fit.mean_absolute,
                               1000 * fit.peak_to_valley,
                               1000 * fit.extent,
                               1000 * fit.width,
                               1000 * fit.mean_range,
                               fit.system_error,
                               fit.normal_sigma / kDegrees.factor,
                               1000 * fit.distance_sigma,
                               c.x(),
                               c.y(),
                               c.z(),
                               fit.area,
                               fit.axis_u.x(),
                               fit.axis_u.y(),
                               fit.axis_u.z(),
                               fit.axis_v.x(),
                               fit.axis_v.y(),
                               fit.axis_v.z(),
                               fit.covariance(0, 0),
                               fit.covariance(0, 1),
                               fit.covariance(1, 1),
                               fit.covariance(0, 2),
                               fit.covariance(1, 2),
                               fit.covariance(2, 2),
                               fit.chi_squared,
                               1000 * fit.unexplained}) {
      file.stream() << ',' << number_text(value);
    }
    file.stream() << '\n';
  }
  file.commit();
}

}  // namespace facula
