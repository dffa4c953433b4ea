// SPDX-License-Identifier: GPL-3.0-or-later
//
// Planes, angles and flatness: public real scans against what their notes and their makers' tests
// say, and the minimum zone against an exact judge. Sets that are not there are named.
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/measure/plane_relations.hpp>
#include <facula/reconstruct/register/scan_project.hpp>
#include <facula/tests/bench/accuracy/studies.hpp>
#include <facula/tests/reconstruct/corner_series.hpp>
#include <facula/tests/reconstruct/width_comparison.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

/// A figure with its spread over the scans, and the notes' own.
struct Noted {
  const char* what;
  const Series& series;
  double mean;
  double spread;
};

void add_noted(Study& study, const Noted& noted) {
  const std::string measured =
      decimals(noted.series.mean(), 2) + " ± " + decimals(noted.series.spread(), 2) + "°";
  const std::string notes = decimals(noted.mean, 2) + " ± " + decimals(noted.spread, 2) + "°";
  study.tables.front().rows.push_back({noted.what, measured, notes});
  const double off = std::abs(noted.series.mean() - noted.mean);
  study.verdicts.push_back(
      {std::string(noted.what) + ": within one standard deviation of the notes",
       decimals(off, 2) + "° off",
       off <= noted.spread});
}

void study_tilt_zero(const std::filesystem::path& folder, Study& study) {
  std::vector<double> zeros = tilt_zero_series(folder).zero.values;
  std::sort(zeros.begin(), zeros.end());
  const double middle = zeros[zeros.size() / 2];
  study.tables.front().rows.push_back(
      {"`os3ds` tilt zero, rising sweeps of 7 scans: median (least, largest)",
       decimals(middle, 1) + "° (" + decimals(zeros.front(), 1) + ", " + decimals(zeros.back(), 1) +
           ")",
       "-8 ± 2°"});
  study.verdicts.push_back({"`os3ds` tilt zero within 2° of the notes",
                            decimals(std::abs(middle + 8), 1) + "° off",
                            std::abs(middle + 8) <= 2});
}

void study_corner(const std::filesystem::path& folder, Study& study) {
  const CornerSeries given = corner_series(folder, 0);
  const CornerSeries turned = corner_series(folder, -8 * kDegree);
  add_noted(study, {"`os3ds` corner, 6 scans, walls A and B", given.ab, 90.10, 0.35});
  add_noted(study, {"`os3ds` corner, tilt -8°, A and B", turned.ab, 90.30, 0.35});
  add_noted(study, {"`os3ds` corner, tilt -8°, A and ceiling C", turned.ac, 89.66, 0.59});
  add_noted(study, {"`os3ds` corner, tilt -8°, B and C", turned.bc, 90.18, 0.53});
}

/// PCL's test expects a/d, b/d, c/d = -0.8964, -0.5868, -1.208 and counts points within 3 cm.
void study_pcl_plane(const std::filesystem::path& file, Study& study) {
  const Eigen::Vector3d ratio(-0.8964, -0.5868, -1.208);
  const Plane published{-ratio.normalized(), 1 / ratio.norm()};
  const auto planes = extract_planes(read_cloud(file), {.inlier_distance = 0.03});
  if (planes.empty()) {
    study.verdicts.push_back({"`pcl-test`: the plane of PCL's own test", "none found", false});
    return;
  }
  const Plane& found = planes.front().fit.plane;
  const double off = angle_between(found, published) / kDegree;
  const auto text = [](const Plane& plane) {
    return "(" + decimals(plane.normal.x(), 4) + ", " + decimals(plane.normal.y(), 4) + ", " +
           decimals(plane.normal.z(), 4) + "), " + decimals(plane.distance, 4) + " m";
  };
  study.tables.front().rows.push_back(
      {"`pcl-test`, the plane of PCL's own test: normal and distance",
       text(found),
       text(published)});
  study.verdicts.push_back(
      {"`pcl-test`: within 0.5° of PCL's plane", decimals(off, 3) + "° off", off <= 0.5});
}

/// The largest plane whose normal lies along `axis`, after the plane `after`.
const PlaneFit* plane_along(const std::vector<ExtractedPlane>& planes,
                            const Eigen::Vector3d& axis,
                            const PlaneFit* after = nullptr) {
  for (const ExtractedPlane& plane : planes) {
    if (&plane.fit == after) {
      after = nullptr;
    } else if (after == nullptr && std::abs(plane.fit.plane.normal.dot(axis)) > 0.97) {
      return &plane.fit;
    }
  }
  return nullptr;
}

/// Walls across y and the floor across z, as the notes have them: thinned to 3 cm, band of 3 cm.
void study_corridor(const std::filesystem::path& folder, Study& study) {
  PointCloud cloud = thin_by_voxel(read_scan_project(folder).scans.front().cloud, 0.03);
  estimate_normals(cloud);
  const auto planes = extract_planes(cloud, {.inlier_distance = 0.03});
  const PlaneFit* left = plane_along(planes, Eigen::Vector3d::UnitY());
  const PlaneFit* right = plane_along(planes, Eigen::Vector3d::UnitY(), left);
  const PlaneFit* floor = plane_along(planes, Eigen::Vector3d::UnitZ());
  if (left == nullptr || right == nullptr || floor == nullptr) {
    study.verdicts.push_back({"`3dtk-dat`: two walls and a floor", "not found", false});
    return;
  }
  auto& rows = study.tables.front().rows;
  const auto mm = [](double metres) { return decimals(1000 * metres, 1); };
  const auto angle = [](const PlaneFit& a, const PlaneFit& b) {
    const Measured measured = measured_angle(a, b);
    return decimals(measured.value / kDegree, 2) + " ± " + decimals(measured.sigma / kDegree, 2);
  };
  rows.push_back({"`3dtk-dat` scan 0, walls: rms [mm]",
                  mm(std::min(left->rms, right->rms)) + ", " + mm(std::max(left->rms, right->rms)),
                  "10, 11"});
  const double apart = distance_between(*left, *right);
  rows.push_back({"`3dtk-dat` walls apart [m]", decimals(apart, 3), "4.75"});
  rows.push_back({"`3dtk-dat` walls open by, with the sigma of independent noise [°]",
                  angle(*left, *right),
                  "0.17"});
  rows.push_back({"`3dtk-dat` walls to floor [°]",
                  angle(*left, *floor) + ", " + angle(*right, *floor),
                  "89.9"});
  study.verdicts.push_back({"`3dtk-dat`: walls 4.75 m apart to 1 cm",
                            decimals(apart, 3) + " m",
                            std::abs(apart - 4.75) <= 0.01});
}

void study_minimum_zone(unsigned clouds, Study& study) {
  const WidthComparison found = compare_widths(clouds);
  study.verdicts.push_back({"minimum zone equal to CGAL's exact width to 1e-12 of it, over " +
                                std::to_string(found.judged) +
                                " clouds of twelve kinds, and 0 for " + std::to_string(found.flat) +
                                " that lie in a plane",
                            decimals(1e15 * found.worst, 1) + "e-15 at worst",
                            found.worst <= 1e-12 && found.flat_is_zero});
}

}  // namespace

Study study_planes(const StudyOptions& options) {
  using Part = void (*)(const std::filesystem::path&, Study&);
  Study study;
  study.title = "Planes, angles and flatness";
  study.paragraphs = {
      "Real scans this time, of public sets that hold no surveyed truth: beside each figure stands "
      "what the notes of the set, or its makers' own test, say. Spreads are over scans."};
  study.tables = {{.caption = "Planes of real scans.", .columns = {"what", "measured", "notes"}}};
  std::vector<std::pair<const char*, Part>> parts = {
      {"range/os3ds-rotating-lidar", study_corner},
      {"range/pcl-test/sac_plane_test.pcd", study_pcl_plane},
      {"range/3dtk-dat", study_corridor}};
  // Long, and tested by itself (reconstruct/tilt_zero).
  if (!options.small) parts.insert(parts.begin() + 1, {parts.front().first, study_tilt_zero});
  std::set<std::string> absent;
  for (const auto& [set, part] : parts) {
    const auto found = real_data(set);
    if (found) {
      part(*found, study);
    } else {
      absent.insert(set);
    }
  }
  for (const std::string& set : absent) {
    study.paragraphs.push_back("The set `" + set + "` is absent, so it is not measured here.");
  }
  if (study.tables.front().rows.empty()) study.tables.clear();
  study_minimum_zone(options.small ? 24 : 240, study);
  return study;
}

}  // namespace facula
