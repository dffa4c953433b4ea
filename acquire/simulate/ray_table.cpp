// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/simulate/ray_table.hpp>

#include <limits>

namespace facula {
namespace {

using Eigen::Vector2d;

// Rays through a grid of pixel positions that starts at `first` in both directions.
std::vector<Vector2d> rays_from(const Camera& camera, double first, int cols, int rows) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Vector2d> rays;
  rays.reserve(static_cast<std::size_t>(cols) * static_cast<std::size_t>(rows));
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) {
      rays.push_back(camera.undistort({c + first, r + first}).value_or(Vector2d(nan, nan)));
    }
  }
  return rays;
}

}  // namespace

RayTable::RayTable(const Camera& camera)
    : width_(camera.width),
      height_(camera.height),
      centre_(rays_from(camera, 0.0, width_, height_)),
      corner_(rays_from(camera, -0.5, width_ + 1, height_ + 1)) {}

Vector2d RayTable::within(int r, int c, int i, int grid) const {
  const int row = i / grid;
  const double v = (row + 0.5) / grid;
  const double u = (i % grid + 0.5) / grid;
  const Vector2d* above =
      &corner_[static_cast<std::size_t>(r) * static_cast<std::size_t>(width_ + 1) +
               static_cast<std::size_t>(c)];
  const Vector2d* below = above + width_ + 1;
  return (1 - v) * ((1 - u) * above[0] + u * above[1]) + v * ((1 - u) * below[0] + u * below[1]);
}

}  // namespace facula
