// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>
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

/// What stands in a rig for a head that was calibrated without a board.
void describe_plain_calibrations(const Rig& rig, Figures& figures) {
  if (rig.range) {
    figures.number("range_slope", "range model, slope A (px mm)", 1000 * rig.range->slope, 1);
    figures.number("range_vanishing_px", "  vanishing position", rig.range->vanishing, 3);
    figures.number("range_bend", "  bend (1/px^2)", rig.range->bend, 10);
  }
  if (rig.compensation) {
    figures.count(
        "compensation_walls", "compensation table, walls", rig.compensation->planes().size());
    figures.count(
        "compensation_lines", "  lines", static_cast<std::size_t>(rig.compensation->lines()));
  }
  if (rig.profile_polynomial) {
    const ProfilePolynomial& p = *rig.profile_polynomial;
    figures.count(
        "profile_degree", "profile polynomial, degree", static_cast<std::size_t>(p.degree()));
    figures.numbers("profile_from_to_px", "  from, to", {p.lowest_px, p.highest_px}, 2);
  }
  figures.flag("profile_projection", "projection of the sheet", rig.profile_projection.has_value());
  if (rig.two_line) {
    figures.number(
        "two_line_spacing_mm", "two-line head, spacing", 1000 * rig.two_line->spacing, 3);
    figures.number("two_line_drift", "  drift (mm per m)", 1000 * rig.two_line->divergence, 3);
    figures.number("two_line_medium_index", "  medium index", rig.two_line->medium_index, 3);
  }
}

/// Which parameters the rig knows how well.
void describe_covariance(const Rig& rig, Figures& figures) {
  figures.flag("covariance", "covariance", rig.covariance.has_value());
  if (!rig.covariance) {
    figures.note(
        "The rig has no covariance: the sigmas of its points hold the noise of the line alone, not "
        "that of the calibration; 'facula calibrate joint' estimates it.");
    return;
  }
  FigureTable table{"parameters",
                    "Parameters and their sigma:",
                    {{"name", "name", 0}, {"sigma", "sigma", 6}},
                    {}};
  for (const std::string& name : rig.covariance->parameters)
    table.rows.push_back({name, parameter_sigma(rig, name)});
  figures.table(std::move(table));
}

}  // namespace

void describe(const Rig& rig, Figures& figures) {
  const Camera& camera = rig.camera;
  figures.text("name", "name", rig.name);
  figures.count("image_width_px", "image width", static_cast<std::size_t>(camera.width));
  figures.count("image_height_px", "image height", static_cast<std::size_t>(camera.height));
  figures.numbers("focal_length_px", "focal length x y", {camera.fx, camera.fy}, 2);
  figures.numbers("principal_point_px", "principal point x y", {camera.cx, camera.cy}, 2);
  figures.numbers("distortion",
                  "distortion k1 k2 p1 p2 k3",
                  {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3},
                  5);
  figures.text(
      "stripe", "stripe", rig.stripe_direction == StripeDirection::kPerRow ? "upright" : "level");
  figures.text("axis", "axis", to_string(rig.axis.kind));
  figures.count("lasers", "laser planes", rig.lasers.size());
  FigureTable table{"laser_planes",
                    "Laser planes (normal . x = distance, camera frame):",
                    {{"name", "name", 0},
                     {"normal_x", "nx", 5},
                     {"normal_y", "ny", 5},
                     {"normal_z", "nz", 5},
                     {"distance_mm", "distance", 3},
                     {"bow_deg", "bow", 3}},
                    {}};
  for (const LaserPlane& laser : rig.lasers) {
    table.rows.push_back({laser.name,
                          laser.normal.x(),
                          laser.normal.y(),
                          laser.normal.z(),
                          1000 * laser.distance,
                          laser.bow / kDegrees.factor});
  }
  if (!table.rows.empty()) figures.table(std::move(table));
  describe_plain_calibrations(rig, figures);
  describe_covariance(rig, figures);
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
