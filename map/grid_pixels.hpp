// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/grid_image.hpp>
#include <facula/map/navigation_grid.hpp>

namespace facula {

/// What a YAML file says about the grey values of its picture.
struct GridRule {
  GridMode mode = GridMode::kTrinary;
  bool negate = false;
  double occupied_thresh = 0.65;  ///< [1]
  double free_thresh = 0.196;     ///< [1]
};

/// The picture of a grid, as nav2's map saver chooses grey values; in trinary from the three
/// states, else from the probabilities.
GridImage image_of(const NavigationGrid& grid, const GridFileOptions& options);

/// The picture's cells as nav2's map server publishes them: `occupancy` 0 to 100 or -1, and
/// `cells`, occupied from 50 %. Size and place of the grid are left alone.
void read_pixels(const GridImage& image, const GridRule& rule, NavigationGrid& grid);

}  // namespace facula
