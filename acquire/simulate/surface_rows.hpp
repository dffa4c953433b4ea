// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/laser_fan.hpp>
#include <facula/acquire/simulate/ray_table.hpp>
#include <facula/acquire/simulate/scene.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Whether the laser sees a spot.
enum class SpotLight { kUnknown, kFree, kBlocked };

/// What a ray of the camera meets, in the camera frame.
struct Surface {
  int object = -1;  ///< -1: nothing
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double low = std::numeric_limits<double>::infinity();  ///< sheet -+ the reach of its light: the
  double high =
      -std::numeric_limits<double>::infinity();  ///< sheet shines for low <= 0 <= high [m]
  SpotLight light = SpotLight::kUnknown;

  bool in_reach() const { return low <= 0 && high >= 0; }
};

bool same_plane(const Surface& a, const Surface& b);

/// Whether both lie on one smooth face of one object; its edges turn the normal by more.
bool same_bend(const Surface& a, const Surface& b);

/// The surfaces that the pixels of one frame show, row by row from the top. Rows are kept in a ring
/// of four: looking at row r needs r - 1 to r + 1, tracing odd row r + 1 needs r and r + 2.
class SurfaceRows {
 public:
  /// `fan` may be absent: then nothing is in reach of light. All are referred to.
  SurfaceRows(const Scene& scene,
              const RayTable& rays,
              const RigidTransform& world_from_camera,
              const LaserFan* fan);

  /// Makes rows r - 1 to r + 1 available; r must not go back.
  void advance_to(int r);

  Surface& at(int r, int c) {
    return ring_[static_cast<std::size_t>(r) % ring_.size()][static_cast<std::size_t>(c)];
  }
  const std::vector<Surface>& row(int r) const {
    return ring_[static_cast<std::size_t>(r) % ring_.size()];
  }

  template <typename Predicate>
  bool neighbours_all(int r, int c, const Predicate& holds) {
    for (int y = std::max(r - 1, 0); y <= std::min(r + 1, rays_.height() - 1); ++y) {
      for (int x = std::max(c - 1, 0); x <= std::min(c + 1, rays_.width() - 1); ++x) {
        if (!holds(at(y, x))) return false;
      }
    }
    return true;
  }

  /// The first surface along a ray, given as a point of the plane z = 1.
  Surface cast(const Eigen::Vector2d& ray) const;

  /// The same for a ray that is known to meet this convex object, or this plane, first.
  Surface cast_on(int object, const Eigen::Vector2d& ray) const;
  Surface on_plane(const Surface& plane, const Eigen::Vector2d& ray) const;

  Eigen::Vector3d in_world(const Eigen::Vector3d& x) const {
    return camera_in_world_ + world_from_camera_ * x;
  }
  const Eigen::Matrix3d& world_from_camera() const { return world_from_camera_; }  ///< rotation

 private:
  Surface surface_at(const Eigen::Vector3d& x, const Eigen::Vector3d& normal, int object) const;
  void trace_next_rows();
  void trace_alone(int r);
  Surface trace_between(const Surface& a, const Surface& b, int r, int c) const;

  const Scene& scene_;
  const RayTable& rays_;
  const LaserFan* fan_;
  Eigen::Matrix3d world_from_camera_;  // rotation
  Eigen::Vector3d camera_in_world_;
  std::vector<RigidTransform> object_from_camera_;
  int traced_ = 0;  // rows above this one are traced
  std::array<std::vector<Surface>, 4> ring_;
};

}  // namespace facula
