// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/camera.hpp>

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// The rays of a camera's pixels, undistorted once. Rays are points of the plane z = 1, NaN where
/// the distortion cannot be inverted.
class RayTable {
 public:
  explicit RayTable(const Camera& camera);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Through the centre of a pixel.
  const Eigen::Vector2d& centre(int r, int c) const {
    return centre_[static_cast<std::size_t>(r) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(c)];
  }

  /// Through the middle of sub-pixel `i` of grid x grid (row by row), bilinear between the rays of
  /// the pixel's corners: within a pixel the distortion bends by less than 0.001 px.
  Eigen::Vector2d within(int r, int c, int i, int grid) const;

 private:
  int width_ = 0;
  int height_ = 0;
  std::vector<Eigen::Vector2d> centre_;
  std::vector<Eigen::Vector2d> corner_;  // width + 1 a row
};

}  // namespace facula
