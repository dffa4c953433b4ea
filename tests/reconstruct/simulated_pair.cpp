// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/tests/reconstruct/simulated_pair.hpp>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace facula {
namespace {

double between(double low, double high, Random& random) {
  return low + (high - low) * random.uniform();
}

Shape random_shape(Random& random) {
  const double kind = random.uniform();
  if (kind < 0.6) {
    return BoxShape{
        {between(0.3, 1.2, random), between(0.3, 1.2, random), between(0.3, 2, random)}};
  }
  if (kind < 0.8) return SphereShape{between(0.2, 0.6, random)};
  return CylinderShape{between(0.1, 0.4, random), between(0.5, 2.5, random)};
}

Eigen::Vector3d random_place(const Eigen::Vector3d& room, double margin, Random& random) {
  const Eigen::Vector3d half = room / 2 - Eigen::Vector3d::Constant(margin);
  return {between(-half.x(), half.x(), random),
          between(-half.y(), half.y(), random),
          between(-half.z(), half.z(), random)};
}

/// The room's floor lies at z = -height / 2.
Scene random_scene(const Eigen::Vector3d& room, Random& random) {
  std::vector<SceneObject> objects;
  objects.push_back({.name = "room", .shape = RoomShape{room}, .world_from_object = {}});
  for (int i = 0; i < 8; ++i) {
    SceneObject object;
    object.name = "thing " + std::to_string(i);
    object.shape = random_shape(random);
    object.world_from_object.rotation =
        Eigen::AngleAxisd(between(0, std::numbers::pi, random), Eigen::Vector3d::UnitZ());
    object.world_from_object.translation = random_place(room, 0.3, random);
    objects.push_back(std::move(object));
  }
  return Scene(std::move(objects));
}

bool is_free(const Scene& scene, const Eigen::Vector3d& place) {
  return !scene.inside(place) && scene.distance(place) > 0.3;
}

RigidTransform stand_at(const Eigen::Vector3d& place, Random& random) {
  const Eigen::AngleAxisd heading(between(-std::numbers::pi, std::numbers::pi, random),
                                  Eigen::Vector3d::UnitZ());
  return {Eigen::Quaterniond(heading), place};
}

/// Two free places `distance` apart at about the same height.
std::pair<Eigen::Vector3d, Eigen::Vector3d> two_places(const Scene& scene,
                                                       const Eigen::Vector3d& room,
                                                       double distance,
                                                       Random& random) {
  for (;;) {
    const Eigen::Vector3d a = random_place(room, 0.5, random);
    const double way = between(-std::numbers::pi, std::numbers::pi, random);
    const Eigen::Vector3d b =
        a + Eigen::Vector3d(
                distance * std::cos(way), distance * std::sin(way), between(-0.2, 0.2, random));
    if (is_free(scene, a) && is_free(scene, b)) return {a, b};
  }
}

PosedCloud scan_from(const Scene& scene,
                     const RigidTransform& stand,
                     const SimulatedPairOptions& options,
                     Random& random) {
  PosedCloud scan;
  const double phase = random.uniform();
  for (int col = 0; col < options.cols; ++col) {
    for (int row = 0; row < options.rows; ++row) {
      const double yaw = 2 * std::numbers::pi * (col + phase) / options.cols;
      const double pitch =
          (row + 0.5 - options.rows / 2.0) / options.rows * 100 * std::numbers::pi / 180;
      const Eigen::Vector3d ray(
          std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch));
      const auto hit = scene.first_hit(stand.translation, stand.rotation * ray);
      if (!hit) continue;
      const double range = hit->distance + options.sigma * random.normal();
      scan.cloud.points.push_back((range * ray).cast<float>());
    }
  }
  scan.cloud.sigma.assign(scan.cloud.size(), static_cast<float>(options.sigma));
  scan.cloud.sensor_origin.assign(scan.cloud.size(), Eigen::Vector3f::Zero());
  scan.world_from_scan = stand;
  return scan;
}

}  // namespace

SimulatedPair simulate_pair(const SimulatedPairOptions& options) {
  Random random(options.seed, 4);
  const Eigen::Vector3d room(between(4, 7, random), between(3, 6, random), between(2.5, 3, random));
  const Scene scene = random_scene(room, random);
  const auto [there, here] = two_places(scene, room, options.distance, random);
  SimulatedPair pair;
  pair.target = scan_from(scene, stand_at(there, random), options, random);
  pair.source = scan_from(scene, stand_at(here, random), options, random);
  pair.target.name = "target";
  pair.source.name = "source";
  pair.target_from_source = pair.target.world_from_scan.inverse() * pair.source.world_from_scan;
  return pair;
}

}  // namespace facula
