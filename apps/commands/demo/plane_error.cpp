// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/commands/demo/plane_error.hpp>
#include <facula/reconstruct/measure/plane_relations.hpp>

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

struct FoundWall {
  const TrueWall* truth = nullptr;
  const PlaneFit* fit = nullptr;
};

std::vector<FoundWall> found_walls(const std::vector<ExtractedPlane>& planes,
                                   const std::vector<TrueWall>& walls) {
  std::vector<FoundWall> found;
  for (const TrueWall& wall : walls) {
    if (const PlaneFit* fit = matching_plane(wall, planes)) found.push_back({&wall, fit});
  }
  return found;
}

/// Of the angles between all pairs of walls: the largest error, and the root mean square of error
/// over stated uncertainty, which is near 1 where the uncertainty is honest.
struct AngleErrors {
  double largest = 0;         ///< [rad]
  double rms_over_sigma = 0;  ///< [1]
};

AngleErrors angle_errors(const std::vector<FoundWall>& walls) {
  AngleErrors errors;
  double squares = 0;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    for (std::size_t j = i + 1; j < walls.size(); ++j) {
      const Measured found = measured_angle(*walls[i].fit, *walls[j].fit);
      const double truth = angle_between(walls[i].truth->plane, walls[j].truth->plane);
      errors.largest = std::max(errors.largest, std::abs(found.value - truth));
      squares += std::pow((found.value - truth) / found.sigma, 2);
      ++pairs;
    }
  }
  if (pairs > 0) errors.rms_over_sigma = std::sqrt(squares / static_cast<double>(pairs));
  return errors;
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
  const std::vector<FoundWall> found = found_walls(planes, walls);
  for (const FoundWall& wall : found) {
    table.rows.push_back({wall.truth->name,
                          static_cast<long long>(wall.fit->points),
                          angle_between(wall.fit->plane, wall.truth->plane) / kDegrees.factor,
                          1000 * offset_from(*wall.truth, *wall.fit),
                          1000 * wall.fit->rms,
                          1000 * wall.fit->peak_to_valley});
  }
  figures.count("planes", "planes found", planes.size());
  figures.count("walls_true", "walls in truth", walls.size());
  figures.count("walls_found", "walls found", found.size());
  figures.number("wall_pair_angle_error_max_deg",
                 "angle between two walls, largest error",
                 angle_errors(found).largest / kDegrees.factor,
                 4);
  figures.table(std::move(table));
}

void report_angle_errors(const std::vector<ExtractedPlane>& planes,
                         const std::vector<TrueWall>& walls,
                         Figures& figures) {
  const std::vector<FoundWall> found = found_walls(planes, walls);
  const AngleErrors errors = angle_errors(found);
  figures.count("walls_found", "walls found", found.size());
  figures.number("angle_error_max_deg", "largest error", errors.largest / kDegrees.factor, 4);
  figures.number("angle_error_rms_over_sigma",
                 "errors over stated uncertainties, rms",
                 errors.rms_over_sigma,
                 2);
}

}  // namespace facula
