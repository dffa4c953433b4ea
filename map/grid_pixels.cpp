// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/grid_pixels.hpp>

#include <cmath>

namespace facula {
namespace {

constexpr std::uint8_t kRawUnknown = 255;
constexpr std::uint8_t kScaleUnknown = 128;  // transparent; ROS 1 wants it between the thresholds

std::uint8_t scale_grey(std::int8_t percent) {
  return percent < 0 ? kScaleUnknown
                     : static_cast<std::uint8_t>(std::lround(255 * (100 - percent) / 100.0));
}

std::uint8_t raw_grey(std::int8_t percent) {
  return percent < 0 ? kRawUnknown : static_cast<std::uint8_t>(percent);
}

/// nav2_map_server's loadMapFromFile().
std::int8_t published(const GridImage& image, std::size_t i, const GridRule& rule) {
  const std::uint8_t grey = image.grey[i];
  if (rule.mode == GridMode::kRaw) {
    return grey <= 100 ? static_cast<std::int8_t>(grey) : std::int8_t{-1};
  }
  const double occupied = (rule.negate ? grey : 255 - grey) / 255.0;
  if (rule.mode == GridMode::kScale && !image.opaque(i)) return -1;
  if (occupied > rule.occupied_thresh) return 100;
  if (occupied < rule.free_thresh) return 0;
  if (rule.mode == GridMode::kTrinary) return -1;
  const double stretched =
      (occupied - rule.free_thresh) / (rule.occupied_thresh - rule.free_thresh) * 100;
  return static_cast<std::int8_t>(std::rint(stretched));
}

}  // namespace

GridMode grid_mode(const std::string& word) {
  for (const GridMode mode : {GridMode::kTrinary, GridMode::kScale, GridMode::kRaw}) {
    if (word == to_string(mode)) return mode;
  }
  fail("expected the mode trinary, scale or raw of a grid, got '", word, "'");
}

std::string to_string(GridMode mode) {
  if (mode == GridMode::kScale) return "scale";
  return mode == GridMode::kRaw ? "raw" : "trinary";
}

void GridFileOptions::check() const {
  require(!negate || mode != GridMode::kRaw,
          "GridFileOptions: expected negate in mode trinary or scale, got it in raw, where map "
          "servers do not agree on it");
}

GridImage image_of(const NavigationGrid& grid, const GridFileOptions& options) {
  GridImage image{.rows = grid.rows, .cols = grid.cols, .grey = {}, .alpha = {}};
  if (options.mode == GridMode::kTrinary) {
    image.grey = grid.cells;
  } else {
    for (const std::int8_t percent : grid.occupancy) {
      image.grey.push_back(options.mode == GridMode::kScale ? scale_grey(percent)
                                                            : raw_grey(percent));
      if (options.mode == GridMode::kScale) image.alpha.push_back(percent < 0 ? 0 : 255);
    }
  }
  if (options.negate) {
    for (std::uint8_t& grey : image.grey) grey = static_cast<std::uint8_t>(255 - grey);
  }
  return image;
}

void read_pixels(const GridImage& image, const GridRule& rule, NavigationGrid& grid) {
  grid.cells.resize(image.size());
  grid.occupancy.resize(image.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const std::int8_t percent = published(image, i, rule);
    grid.occupancy[i] = percent;
    grid.cells[i] = percent < 0     ? NavigationGrid::kUnknown
                    : percent >= 50 ? NavigationGrid::kOccupied
                                    : NavigationGrid::kFree;
  }
}

}  // namespace facula
