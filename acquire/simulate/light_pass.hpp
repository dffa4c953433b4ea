// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/laser_layer.hpp>
#include <facula/acquire/simulate/light_path.hpp>
#include <facula/acquire/simulate/object_light.hpp>
#include <facula/acquire/simulate/surface_rows.hpp>

#include <array>
#include <vector>

namespace facula {

/// Scene and camera of the light that is summed up, all referred to.
struct LightSetting {
  const Scene& scene;
  const RayTable& rays;
  const std::vector<ObjectLight>& objects;
  RigidTransform world_from_camera;
};

/// Sums the light that each pixel gets straight from surfaces that one path of the laser lights, or
/// none. What mirrors show is not in it: see mirror_view.hpp.
class LightPass {
 public:
  /// `path` is null while the laser is off. Both are referred to.
  LightPass(const LightSetting& setting, const LightPath* path);

  /// Adds the light of the next row, from the top: `ambient` of each channel of a pixel in turn,
  /// and `laser` of the laser as the channel sees it that sees it best [DN]. A null `ambient` is
  /// left out.
  void add_row(int r, int channels, double* ambient, LaserLayer& laser);

  /// Whether the pixel or one beside it shows a mirror; of the row added last.
  bool shows_mirror(int r, int c);

 private:
  static constexpr int kLaserGrid = 4;  // sub-pixels each way where the sheet's light can come in
  static constexpr int kLaserSpots = kLaserGrid * kLaserGrid;

  void find_reach(int r);
  bool near_sheet(int c) const;
  bool at_edge(int r, int c) const;
  Eigen::Vector3d ambient_at(int r, int c) const;
  void add_near_sheet(int r, int c, Eigen::Vector3d& ambient, LaserLayer& laser);
  bool is_convex(const Surface& surface) const;
  SpotLight common_light(int r, int c);
  SpotLight light_at(Surface& spot) const;
  const Eigen::Vector3d& ambient_of(const Surface& spot) const;
  std::array<double, kLaserSpots> laser_over(std::array<Surface, kLaserSpots>& spots) const;
  double laser_signal(Surface& spot, double off, double width) const;

  const LightSetting& setting_;
  const LightPath* path_;
  SurfaceRows surfaces_;
  std::vector<double> column_low_;
  std::vector<double> column_high_;
};

}  // namespace facula
