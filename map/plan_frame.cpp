// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/cell_layers.hpp>
#include <facula/map/plan_frame.hpp>

#include <algorithm>
#include <array>

namespace facula {
namespace {

constexpr double kMostColumns = 268435456.0;  // 16384 x 16384

}  // namespace

std::optional<PlanFrame> plan_frame(const OccupancyMap& map, const BrickChoice& chosen) {
  std::array<int, 2> low = {kKeyLimit, kKeyLimit};
  std::array<int, 2> high = {0, 0};
  map.for_each_brick([&](const OccupancyMap::BrickView& brick) {
    for (std::uint64_t left = columns_of(chosen(brick)); left != 0; left &= left - 1) {
      const int column = std::countr_zero(left);
      const std::array<int, 2> key = {brick.first[0] + (column & 7), brick.first[1] + column / 8};
      for (std::size_t i = 0; i < 2; ++i) {
        low[i] = std::min(low[i], key[i]);
        high[i] = std::max(high[i], key[i] + 1);
      }
    }
  });
  if (low[0] >= high[0]) return std::nullopt;
  PlanFrame frame{.rows = high[1] - low[1],
                  .cols = high[0] - low[0],
                  .first_x = low[0],
                  .first_y = low[1],
                  .resolution = map.resolution()};
  require(static_cast<double>(frame.rows) * frame.cols <= kMostColumns,
          "a picture of ",
          frame.cols,
          " x ",
          frame.rows,
          " cells from above is too large; use coarser cells or a shorter range");
  return frame;
}

}  // namespace facula
