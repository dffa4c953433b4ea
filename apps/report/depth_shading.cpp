// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/depth_shading.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace facula {
namespace {

struct Offset {
  int x;
  int y;
};

constexpr std::array<Offset, 8> kAround{
    {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-2, -2}, {2, -2}, {-2, 2}, {2, 2}}};

// A cliff of this height is as dark as any higher one.
constexpr float kMostStep = 12;  // [px]

}  // namespace

std::vector<float> depth_shading(const std::vector<float>& height,
                                 int rows,
                                 int cols,
                                 double strength) {
  std::vector<float> light(height.size(), 1.0F);
  const auto at = [&](int row, int col) {
    return height[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) +
                  static_cast<std::size_t>(col)];
  };
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const float here = at(row, col);
      if (std::isnan(here)) continue;
      float above = 0;
      for (const Offset& offset : kAround) {
        const int r = row + offset.y;
        const int c = col + offset.x;
        if (r < 0 || c < 0 || r >= rows || c >= cols) continue;
        const float step = at(r, c) - here;
        if (step > 0) above += std::min(step, kMostStep);
      }
      const double mean = above / static_cast<double>(kAround.size());
      light[static_cast<std::size_t>(row) * static_cast<std::size_t>(cols) +
            static_cast<std::size_t>(col)] = static_cast<float>(std::exp(-strength * mean));
    }
  }
  return light;
}

}  // namespace facula
