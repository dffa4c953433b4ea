// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/acquire/core/scan_stand.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// What a scanner head delivers: a grid of points. Rows are camera rows (camera columns where the
/// line lies flat in the image), columns are the axis positions in the order measured. Cells are
/// stored column by column: cell (row, col) stands at index col * rows + row of every cell array.
/// range, yaw and pitch are the polar form of the point about the origin of the scan frame:
/// range = |x|, yaw = atan2(y, x), pitch = asin(z / range) (source B, 2.10 to 2.17).
struct PolarScan {
  int rows = 0;
  int cols = 0;

  // One entry per cell. Cells that are not valid hold NaN points and zeros.
  std::vector<Eigen::Vector3f> point;  ///< in the scan frame [m]
  std::vector<float> range;            ///< [m]
  std::vector<float> yaw;              ///< [rad], (-pi, pi]
  std::vector<float> pitch;            ///< [rad], [-pi/2, pi/2]
  std::vector<float> intensity;        ///< brightness of the stripe [0..1]
  std::vector<float> sigma;            ///< 1 standard deviation along the camera's ray [m]
  std::vector<std::uint8_t> valid;     ///< 1 where the stripe was seen [0 or 1]

  // One entry per column.
  std::vector<double> axis_position;           ///< [rad], or [m] for a linear axis
  std::vector<double> time;                    ///< since the first column [s]
  std::vector<Eigen::Vector3d> sensor_origin;  ///< camera centre in the scan frame [m]

  RigidTransform world_from_scan;
  ScanStand stand = ScanStand::kFree;  ///< as the capture says

  /// A scan of the given size with no valid cell.
  static PolarScan empty(int rows, int cols);

  std::size_t index(int row, int col) const {
    return static_cast<std::size_t>(col) * static_cast<std::size_t>(rows) +
           static_cast<std::size_t>(row);
  }

  /// Makes a cell valid: stores the point and its polar form. intensity [0..1], sigma [m].
  void set(std::size_t cell,
           const Eigen::Vector3d& point_in_scan,
           float cell_intensity,
           float cell_sigma);

  /// Makes a cell invalid and clears its values.
  void clear(std::size_t cell);

  std::size_t valid_count() const;

  /// Throws Error when an array's length does not fit rows and cols.
  void check() const;
};

}  // namespace facula
