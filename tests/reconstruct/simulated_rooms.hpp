// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace facula {

/// An upright box [m]. The first of a room is seen from inside, the others stand in it.
struct RoomBox {
  Eigen::Vector3d lowest;
  Eigen::Vector3d highest;
};

/// Where the ray from `origin` along unit `direction` enters (or, from inside, leaves) the box [m];
/// infinite where it passes by (the slab method, Kay and Kajiya 1986).
inline double distance_to(const RoomBox& box,
                          const Eigen::Vector3d& origin,
                          const Eigen::Vector3d& direction,
                          bool from_inside) {
  double enter = -INFINITY;
  double leave = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.lowest[i] - origin[i]) / direction[i];
    const double b = (box.highest[i] - origin[i]) / direction[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (from_inside) return leave;
  return enter > 0 && enter < leave ? enter : INFINITY;
}

struct RoomScanner {
  RigidTransform world_from_scan;  ///< where it stands, and how its own frame is turned
  double step = 0.015;             ///< between rays [rad]
  double sigma = 0.002;            ///< of the range [m]
  std::uint64_t seed = 1;
};

/// What a scanner sees of the boxes: rays over the whole sphere, in the scanner's frame.
inline PosedCloud scan_of_room(const std::vector<RoomBox>& boxes, const RoomScanner& scanner) {
  Random random(scanner.seed);
  PosedCloud scan;
  scan.name = "room" + std::to_string(scanner.seed);
  scan.world_from_scan = scanner.world_from_scan;
  const Eigen::Vector3d origin = scanner.world_from_scan.translation;
  for (double tilt = -1.5; tilt <= 1.5; tilt += scanner.step) {
    const double turn = scanner.step / std::cos(tilt);
    for (double pan = 0; pan < 2 * M_PI; pan += turn) {
      const Eigen::Vector3d ray(
          std::cos(tilt) * std::cos(pan), std::cos(tilt) * std::sin(pan), std::sin(tilt));
      const Eigen::Vector3d direction = scanner.world_from_scan.rotation * ray;
      double range = distance_to(boxes.front(), origin, direction, true);
      for (std::size_t i = 1; i < boxes.size(); ++i) {
        range = std::min(range, distance_to(boxes[i], origin, direction, false));
      }
      scan.cloud.points.push_back(((range + scanner.sigma * random.normal()) * ray).cast<float>());
      scan.cloud.sensor_origin.emplace_back(Eigen::Vector3f::Zero());
    }
  }
  return scan;
}

}  // namespace facula
