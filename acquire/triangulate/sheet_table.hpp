// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/triangulate/triangulate.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace facula {

/// triangulate() for a whole scan: the rays of every row are computed once, at a few columns, and
/// interpolated in between (cubic, by value and derivative). The spacing is halved until the ray
/// midway between two columns, where that interpolation is worst, is within 1e-7 px of the exact
/// one. Points then equal those of triangulate() to the same share of a pixel; their sigma is by
/// the derivative itself instead of a difference over one pixel. Where the table does not reach
/// (outside the image, a distortion that cannot be inverted, a rig with a range model and no sheet)
/// triangulate() answers. May be asked from several threads.
class SheetTable {
 public:
  /// Throws Error when the rig has no such laser.
  SheetTable(const Rig& rig, std::size_t laser, int num_threads = 0);

  /// The point of row `row` of the scan (image row, or column for a stripe per column) where the
  /// stripe is at `position` along it; `pixel_sigma` is the standard deviation of that. All [px].
  std::optional<TriangulatedPoint> at(int row, double position, double pixel_sigma) const;

  /// The pixel at `position` along row `row` of the scan.
  Eigen::Vector2d pixel(int row, double position) const;

  double ray_error() const { return ray_error_; }  ///< largest one met midway [px]
  int spacing() const { return spacing_; }         ///< of the columns [px]

 private:
  /// A ray (x, y, 1) and its derivative by the position [1/px].
  struct Ray {
    double x = 0;
    double y = 0;
    double dx = 0;
    double dy = 0;
  };

  Ray exact_ray(const Eigen::Vector2d& pixel, const Eigen::Vector2d* start) const;
  Ray interpolated(int row, double position) const;
  void fill_row(int row);
  double worst_midway() const;
  std::optional<double> meet_sheet(const Eigen::Vector3d& direction) const;
  Eigen::Vector3d sheet_gradient(const Eigen::Vector3d& x) const;

  Rig rig_;
  std::size_t laser_ = 0;
  bool per_row_ = true;
  int rows_ = 0;
  int cols_ = 0;
  int spacing_ = 0;
  int nodes_ = 0;  ///< per row
  std::vector<Ray> rays_;
  double ray_error_ = 0;
  double tan_bow_ = 0;
  Eigen::Vector3d fan_origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d fan_axis_ = Eigen::Vector3d::Zero();
};

}  // namespace facula
