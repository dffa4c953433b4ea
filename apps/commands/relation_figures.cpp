// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/commands/relation_figures.hpp>
#include <facula/reconstruct/measure/tolerance_zone.hpp>

#include <cmath>
#include <numbers>

namespace facula {
namespace {

constexpr double kZoneAngle = 10 * kDegrees.factor;  // nearer to square or parallel has a zone

double degrees(double angle) {
  return angle / kDegrees.factor;
}

std::vector<Eigen::Vector3d> points_of(const FoundPlanes& found, std::size_t plane) {
  std::vector<Eigen::Vector3d> points;
  for (const std::size_t i : found.planes[plane].indices) {
    points.emplace_back(found.cloud.points[i].cast<double>());
  }
  return points;
}

/// The tolerance of a pair by name and the zone's width; empty cells where it is neither.
std::vector<FigureValue> zone_cells(const FoundPlanes& found,
                                    const std::pair<std::size_t, std::size_t>& pair,
                                    double angle,
                                    const RelationOptions& options) {
  const bool parallel = angle < kZoneAngle;
  const bool square = std::numbers::pi / 2 - angle < kZoneAngle;
  if (!parallel && !square) return {std::string("-"), NAN, NAN, NAN};
  const PlaneFit& datum = found.planes[pair.first].fit;
  const PlaneFit& surface = found.planes[pair.second].fit;
  const auto points = points_of(found, pair.second);
  const ToleranceZone zone = parallel ? parallelism(surface, datum, points, options)
                                      : perpendicularity(surface, datum, points, options);
  return {std::string(parallel ? "parallel" : "square"),
          1000 * zone.plane.value,
          1000 * zone.plane.sigma,
          1000 * zone.points};
}

}  // namespace

FigureTable angle_table(const FoundPlanes& found,
                        std::size_t reference,
                        const RelationOptions& options) {
  FigureTable table{"angles",
                    "Angles between planes, and zones of the other about the first:",
                    {{"plane", "plane", 0},
                     {"other", "other", 0},
                     {"angle_deg", "angle", 4},
                     {"angle_sigma_deg", "sigma", 4},
                     {"corner_deg", "corner", 3},
                     {"tolerance", "tolerance", 0},
                     {"zone_mm", "zone", 2},
                     {"zone_sigma_mm", "zone sigma", 2},
                     {"zone_points_mm", "of points", 2}},
                    {}};
  for (const auto& pair : plane_pairs(found.planes, reference)) {
    const PlaneFit& a = found.planes[pair.first].fit;
    const PlaneFit& b = found.planes[pair.second].fit;
    const Measured angle = measured_angle(a, b, options);
    std::vector<FigureValue> row = {static_cast<long long>(pair.first + 1),
                                    static_cast<long long>(pair.second + 1),
                                    degrees(angle.value),
                                    degrees(angle.sigma),
                                    degrees(measured_corner(a, b, options).value)};
    for (FigureValue& cell : zone_cells(found, pair, angle.value, options)) {
      row.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

FigureTable plumb_table(const FoundPlanes& found,
                        const Eigen::Vector3d& up,
                        const RelationOptions& options) {
  FigureTable table{"plumb",
                    "Planes against gravity:",
                    {{"plane", "plane", 0},
                     {"stands", "stands", 0},
                     {"lean_deg", "lean", 4},
                     {"lean_sigma_deg", "sigma", 4},
                     {"slope_percent", "slope", 3}},
                    {}};
  for (std::size_t i = 0; i < found.planes.size(); ++i) {
    const Measured from_up = measured_angle_to(found.planes[i].fit, up, options);
    const bool upright = from_up.value > std::numbers::pi / 4;
    const double lean = upright ? std::numbers::pi / 2 - from_up.value : from_up.value;
    table.rows.push_back({static_cast<long long>(i + 1),
                          std::string(upright ? "upright" : "level"),
                          degrees(lean),
                          degrees(from_up.sigma),
                          100 * std::tan(lean)});
  }
  return table;
}

FigureTable distance_table(const FoundPlanes& found,
                           std::size_t reference,
                           double max_angle,
                           const RelationOptions& options) {
  FigureTable table{"distances",
                    "Distances of the other's centre from the plane, of planes that are parallel:",
                    {{"plane", "plane", 0},
                     {"other", "other", 0},
                     {"distance_mm", "distance", 3},
                     {"distance_sigma_mm", "sigma", 3},
                     {"angle_deg", "angle", 4},
                     {"angle_sigma_deg", "angle sigma", 4}},
                    {}};
  for (const auto& [first, second] : plane_pairs(found.planes, reference)) {
    const PlaneFit& a = found.planes[first].fit;
    const PlaneFit& b = found.planes[second].fit;
    const Measured angle = measured_angle(a, b, options);
    if (angle.value > max_angle) continue;
    const Measured distance = measured_distance(a, b, options);
    table.rows.push_back({static_cast<long long>(first + 1),
                          static_cast<long long>(second + 1),
                          1000 * distance.value,
                          1000 * distance.sigma,
                          degrees(angle.value),
                          degrees(angle.sigma)});
  }
  return table;
}

}  // namespace facula
