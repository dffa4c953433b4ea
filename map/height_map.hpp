// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/occupancy_map.hpp>

#include <cstddef>
#include <filesystem>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct HeightMapOptions {
  /// Cells that reach above are left out, world z [m]: a ceiling, lamps. Infinite = none are.
  double max_height = std::numeric_limits<double>::infinity();

  /// Throws Error when max_height is not a number.
  void check() const;
};

/// A map as a terrain: one height per column of cells. Row 0 is the top of the picture, the largest
/// y.
struct HeightMap {
  int rows = 0;                                      ///< [1]
  int cols = 0;                                      ///< [1]
  double resolution = 0;                             ///< edge of a cell [m]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower left corner, world x and y [m]
  std::vector<float> top;  ///< world z [m] row by row from the top; NaN where nothing is occupied

  std::size_t size() const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
  }
};

/// The upper face of the highest occupied cell of every column that does not reach above
/// `max_height`. The map covers the columns in which something below is known. Throws Error when
/// there are none.
HeightMap height_map(const OccupancyMap& map, const HeightMapOptions& options = {});

/// Writes NAME.tif, 32-bit float metres with NaN for no height, and NAME.tif.yaml, which says
/// where the picture lies: image, resolution, origin (lower left corner), unit. Throws Error when
/// either cannot be written.
void write_height_map(const std::filesystem::path& tiff_path, const HeightMap& heights);

}  // namespace facula
