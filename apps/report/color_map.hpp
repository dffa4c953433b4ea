// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

namespace facula {

/// Colour tables for pictures.
enum class ColorMap {
  kViridis,   ///< dark violet to yellow, lightness rising evenly: for lengths and heights
  kDiverging  ///< blue, white, red: for signed deviations about 0
};

/// Cells without a value, where a picture shows them at all.
inline constexpr Color kNoDataColor{44, 46, 52};

/// Colour at `t`, clamped to [0, 1]; kNoDataColor where t is not a number.
Color color_at(ColorMap map, double t);

/// The colour under `light` times as much light [1], at least 0; what gets too bright is clipped.
Color lit(Color color, double light);

}  // namespace facula
