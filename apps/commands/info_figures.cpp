// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/commands/distance_figures.hpp>
#include <facula/apps/commands/info_figures.hpp>
#include <facula/apps/commands/mesh_figures.hpp>

#include <algorithm>
#include <string>

namespace facula {
namespace {

std::vector<double> numbers(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

void describe_extent(const std::vector<Eigen::Vector3f>& points, Figures& figures) {
  if (points.empty()) return;
  Eigen::Vector3f low = points.front();
  Eigen::Vector3f high = points.front();
  for (const Eigen::Vector3f& x : points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  figures.numbers("min_m", "lower corner", numbers(low.cast<double>()), 4);
  figures.numbers("max_m", "upper corner", numbers(high.cast<double>()), 4);
}

void describe_pose(const RigidTransform& world_from_scan, Figures& figures) {
  const Eigen::Vector3d x = 1000 * world_from_scan.translation;
  figures.numbers("position_mm", "position", numbers(x), 2);
  figures.number("rotation_deg", "turned by", rotation_angle(world_from_scan) / kDegrees.factor, 3);
}

void describe_sigma(const std::vector<float>& sigma, Figures& figures) {
  if (sigma.empty()) return;
  const Spread spread = spread_of({sigma.begin(), sigma.end()});
  figures.number("sigma_median_mm", "sigma, median", 1000 * spread.median, 3);
}

}  // namespace

void describe(const Rig& rig, Figures& figures) {
  const Camera& camera = rig.camera;
  figures.text("name", "name", rig.name);
  figures.count("image_width_px", "image width", static_cast<std::size_t>(camera.width));
  figures.count("image_height_px", "image height", static_cast<std::size_t>(camera.height));
  figures.numbers("focal_length_px", "focal length x y", {camera.fx, camera.fy}, 2);
  figures.numbers("principal_point_px", "principal point x y", {camera.cx, camera.cy}, 2);
  figures.text("axis", "axis", to_string(rig.axis.kind));
  figures.count("lasers", "laser planes", rig.lasers.size());
  FigureTable table{"laser_planes",
                    "Laser planes (normal . x = distance, camera frame):",
                    {{"name", "name", 0},
                     {"normal_x", "nx", 5},
                     {"normal_y", "ny", 5},
                     {"normal_z", "nz", 5},
                     {"distance_mm", "distance", 3}},
                    {}};
  for (const LaserPlane& laser : rig.lasers) {
    table.rows.push_back(
        {laser.name, laser.normal.x(), laser.normal.y(), laser.normal.z(), 1000 * laser.distance});
  }
  figures.table(std::move(table));
}

void describe(const Scene& scene, Figures& figures) {
  static constexpr const char* kShapes[] = {"box", "room", "sphere", "cylinder", "mesh"};
  figures.count("object_count", "objects", scene.objects().size());
  FigureTable table{"objects",
                    "Objects:",
                    {{"name", "name", 0},
                     {"shape", "shape", 0},
                     {"x_mm", "x", 1},
                     {"y_mm", "y", 1},
                     {"z_mm", "z", 1},
                     {"albedo", "albedo", 2}},
                    {}};
  for (const SceneObject& object : scene.objects()) {
    const Eigen::Vector3d x = 1000 * object.world_from_object.translation;
    table.rows.push_back({object.name,
                          std::string(kShapes[object.shape.index()]),
                          x.x(),
                          x.y(),
                          x.z(),
                          object.albedo});
  }
  figures.table(std::move(table));
}

void describe(const Capture& capture, Figures& figures) {
  const bool turns = capture.rig.axis.is_revolute();
  const double per_unit = turns ? 1 / kDegrees.factor : 1000;
  const std::string unit = turns ? "_deg" : "_mm";
  figures.text("rig", "rig", capture.rig.name);
  figures.text("axis", "axis", to_string(capture.rig.axis.kind));
  figures.count("frames", "frames", capture.frames.size());
  figures.count("background_frames", "background frames", capture.background.size());
  figures.count("positions", "axis positions", capture.positions.size());
  if (!capture.positions.empty()) {
    figures.number("first" + unit, "first position", capture.positions.front() * per_unit, 3);
    figures.number("last" + unit, "last position", capture.positions.back() * per_unit, 3);
  }
  figures.text("detector", "detector", to_string(capture.stripe.detector));
  figures.text("channel", "channel", to_string(capture.stripe.channel));
  figures.number("line_sigma_px", "expected line width", capture.stripe.sigma, 2);
  figures.flag("zero_line", "zero line", capture.zero_line.has_value());
  describe_pose(capture.world_from_scan, figures);
}

void describe(const ScanProject& project, Figures& figures) {
  figures.count("scan_count", "scans", project.scans.size());
  FigureTable table{"scans",
                    "Scans:",
                    {{"name", "name", 0},
                     {"points", "points", 0},
                     {"x_mm", "x", 1},
                     {"y_mm", "y", 1},
                     {"z_mm", "z", 1},
                     {"rotation_deg", "turned by", 3}},
                    {}};
  for (const PosedCloud& scan : project.scans) {
    const Eigen::Vector3d x = 1000 * scan.world_from_scan.translation;
    table.rows.push_back({scan.name,
                          static_cast<long long>(scan.cloud.size()),
                          x.x(),
                          x.y(),
                          x.z(),
                          rotation_angle(scan.world_from_scan) / kDegrees.factor});
  }
  figures.table(std::move(table));
}

void describe(const PolarScan& scan, Figures& figures) {
  figures.count("rows", "rows", static_cast<std::size_t>(scan.rows));
  figures.count("cols", "columns", static_cast<std::size_t>(scan.cols));
  describe_pose(scan.world_from_scan, figures);
  describe(cloud_from_scan(scan), figures);
}

void describe(const PointCloud& cloud, Figures& figures) {
  figures.count("points", "points", cloud.size());
  describe_extent(cloud.points, figures);
  describe_sigma(cloud.sigma, figures);
  figures.flag("normals", "normals", !cloud.normals.empty());
  figures.flag("colors", "colours", !cloud.colors.empty());
}

void describe(const TriangleMesh& mesh, Figures& figures) {
  report_mesh(mesh, figures);
  describe_extent(mesh.vertices, figures);
}

}  // namespace facula
