// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// What a scan says about a place.
enum class Seen : std::uint8_t {
  kUnknown,  ///< outside its view, behind what it saw, or at an edge
  kSurface,  ///< about as far as what it saw there
  kFree,     ///< in front of what it saw: the scanner looked through
};

/// A depth image of a scan, made from its points and sensor origins: central where it was seen from
/// about one place (on the six sides of a cube); flat where the lines of sight are parallel or
/// widen evenly, not necessarily alike in both directions (a camera, a line scanner on a stage).
/// Empty, and silent, where there are no sensor origins or neither holds (a turntable).
class ScanView {
 public:
  ScanView() = default;

  /// `spacing` is the distance between neighbouring points of the cloud [m].
  ScanView(const PointCloud& cloud, double spacing);

  bool empty() const { return cells_.empty(); }

  /// `margin` [m] on either side of the surface counts as the surface.
  Seen at(const Eigen::Vector3d& x, double margin) const;

 private:
  struct Cell {
    float nearest = 0;
    float farthest = -1;  // below nearest: nothing seen here
  };
  struct Pixel {
    int face = 0;
    int row = 0;
    int col = 0;
    double depth = 0;  // along the line of sight, growing away from the scanner [m]
    bool inside = false;
  };
  struct Sights;

  bool fit_flat(const Sights& sights);
  bool fit_central(const Sights& sights);
  void choose_resolution(const PointCloud& cloud);
  void fill(const PointCloud& cloud);
  Eigen::Vector3d flat(const Eigen::Vector3d& x) const;
  Pixel project(const Eigen::Vector3d& x) const;
  Cell& cell(int face, int row, int col);

  bool central_ = false;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();  // flat: rows u, v and the mean sight
  Eigen::Vector2d widening_ = Eigen::Vector2d::Zero();  // flat: of the slopes along u and v [1/m]
  Eigen::Vector2d corner_ = Eigen::Vector2d::Zero();    // flat: of the image [m]
  double slack_ = 0;  // share of the depth that the origins' spread makes uncertain [1]
  double pixel_ = 1;  // edge length: [m] flat, tangent [1] central
  int rows_ = 0;
  int cols_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace facula
