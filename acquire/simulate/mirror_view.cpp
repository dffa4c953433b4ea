// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/mirror_view.hpp>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kGrid = 4;  // sub-pixels each way

}  // namespace

MirrorView::MirrorView(const LightSetting& setting, const std::vector<LightPath>& paths)
    : setting_(setting), paths_(paths), camera_from_world_(setting.world_from_camera.inverse()) {}

void MirrorView::add_pixel(int r, int c, int channels, double* ambient, LaserLayer& laser) const {
  const Scene& scene = setting_.scene;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const Vector2d ray = setting_.rays.within(r, c, i, kGrid);
    const Vector3d direction =
        setting_.world_from_camera.rotation * Vector3d(ray.x(), ray.y(), 1).normalized();
    if (!direction.allFinite()) continue;
    const auto mirror = scene.first_hit(setting_.world_from_camera.translation, direction);
    if (!mirror) continue;
    const double share = setting_.objects[mirror->object].mirror / (kGrid * kGrid);
    if (share == 0) continue;
    const Vector3d onwards = direction - 2 * mirror->normal.dot(direction) * mirror->normal;
    const auto hit = scene.first_hit(mirror->point, onwards);
    if (!hit) continue;
    const ObjectLight& object = setting_.objects[hit->object];
    for (int k = 0; k < channels; ++k) ambient[k] += share * object.ambient[k];
    const Vector3d x = camera_from_world_ * hit->point;
    const Vector3d normal = camera_from_world_.rotation * hit->normal;
    for (const LightPath& path : paths_) {
      const double signal = share * object.laser_share * path.share() * path.fan.signal(x, normal);
      if (signal > 1e-6 && path.open(scene, hit->point)) laser.add(r, c, 0, 0, signal);
    }
  }
}

}  // namespace facula
