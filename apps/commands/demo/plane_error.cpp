// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/commands/demo/plane_error.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr double kLargestAngle = 5 * 0.017453292519943295;  // [rad]
constexpr double kLargestOffset = 0.05;                     // [m]

double offset_from(const TrueWall& wall, const PlaneFit& fit) {
  return wall.plane.signed_distance(fit.centroid);
}

const PlaneFit* matching_plane(const TrueWall& wall, const std::vector<ExtractedPlane>& planes) {
  const PlaneFit* best = nullptr;
  for (const ExtractedPlane& plane : planes) {
    if (angle_between(plane.fit.plane, wall.plane) > kLargestAngle) continue;
    if (std::abs(offset_from(wall, plane.fit)) > kLargestOffset) continue;
    if (best == nullptr || plane.fit.points > best->points) best = &plane.fit;
  }
  return best;
}

double largest_angle_error(const std::vector<const PlaneFit*>& fits,
                           const std::vector<const TrueWall*>& walls) {
  double largest = 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    for (std::size_t j = i + 1; j < fits.size(); ++j) {
      const double found = angle_between(fits[i]->plane, fits[j]->plane);
      const double truth = angle_between(walls[i]->plane, walls[j]->plane);
      largest = std::max(largest, std::abs(found - truth));
    }
  }
  return largest;
}

}  // namespace

std::vector<TrueWall> true_walls(const Scene& scene) {
  static constexpr const char* kNames[3][2] = {
      {"wall -x", "wall +x"}, {"wall -y", "wall +y"}, {"floor", "ceiling"}};
  std::vector<TrueWall> walls;
  for (const SceneObject& object : scene.objects()) {
    const auto* room = std::get_if<RoomShape>(&object.shape);
    if (room == nullptr) continue;
    for (int axis = 0; axis < 3; ++axis) {
      for (int side = 0; side < 2; ++side) {
        Eigen::Vector3d outward = Eigen::Vector3d::Zero();
        outward[axis] = side == 0 ? -1 : 1;
        const Eigen::Vector3d on_wall =
            object.world_from_object * Eigen::Vector3d(outward * (room->size[axis] / 2));
        const Eigen::Vector3d normal = object.world_from_object.rotation * outward;
        walls.push_back({kNames[axis][side], {normal, normal.dot(on_wall)}});
      }
    }
  }
  return walls;
}

void report_plane_errors(const std::vector<ExtractedPlane>& planes,
                         const std::vector<TrueWall>& walls,
                         Figures& figures) {
  FigureTable table{"walls",
                    "",
                    {{"name", "wall", 0},
                     {"points", "points", 0},
                     {"angle_error_deg", "angle error", 4},
                     {"offset_error_mm", "offset error", 3},
                     {"flatness_rms_mm", "flatness rms", 3},
                     {"flatness_p2v_mm", "flatness p2v", 2}},
                    {}};
  std::vector<const PlaneFit*> fits;
  std::vector<const TrueWall*> found;
  for (const TrueWall& wall : walls) {
    const PlaneFit* fit = matching_plane(wall, planes);
    if (fit == nullptr) continue;
    fits.push_back(fit);
    found.push_back(&wall);
    table.rows.push_back({wall.name,
                          static_cast<long long>(fit->points),
                          angle_between(fit->plane, wall.plane) / kDegrees.factor,
                          1000 * offset_from(wall, *fit),
                          1000 * fit->rms,
                          1000 * fit->peak_to_valley});
  }
  figures.count("planes", "planes found", planes.size());
  figures.count("walls_true", "walls in truth", walls.size());
  figures.count("walls_found", "walls found", fits.size());
  figures.number("wall_pair_angle_error_max_deg",
                 "angle between two walls, largest error",
                 largest_angle_error(fits, found) / kDegrees.factor,
                 4);
  figures.table(std::move(table));
}

}  // namespace facula
