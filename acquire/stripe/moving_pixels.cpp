// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/stripe/moving_pixels.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace facula {
namespace {

void check_pair(ImageView8 first, ImageView8 second) {
  require(
      first.rows == second.rows && first.cols == second.cols && first.channels == second.channels,
      "expected two frames of the same size and channels, got ",
      first.cols,
      " x ",
      first.rows,
      " and ",
      second.cols,
      " x ",
      second.rows,
      " px");
}

/// Differences and brightness, one number per pixel, the differences freed of their median so that
/// an even change of the light is none.
struct Comparison {
  int rows = 0;
  int cols = 0;
  std::vector<float> difference;
  std::vector<float> level;

  std::size_t index(int r, int c) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(cols) +
           static_cast<std::size_t>(c);
  }
};

Comparison compare(ImageView8 first, ImageView8 second) {
  Comparison result{first.rows, first.cols, {}, {}};
  const auto count = static_cast<std::size_t>(first.rows) * static_cast<std::size_t>(first.cols);
  result.difference.reserve(count);
  result.level.reserve(count);
  for (int r = 0; r < first.rows; ++r) {
    const std::uint8_t* a = first.row(r);
    const std::uint8_t* b = second.row(r);
    for (int c = 0; c < first.cols; ++c, a += first.channels, b += first.channels) {
      int largest = 0;
      int level = 0;
      for (int k = 0; k < first.channels; ++k) {
        const int d = b[k] - a[k];
        if (std::abs(d) > std::abs(largest)) largest = d;
        level = std::max(level, std::max<int>(a[k], b[k]));
      }
      result.difference.push_back(static_cast<float>(largest));
      result.level.push_back(static_cast<float>(level));
    }
  }
  std::vector<float> sorted = result.difference;
  const float middle = median(sorted);
  for (float& d : result.difference) d -= middle;
  return result;
}

/// Standard deviation of most differences; not below what rounding makes of two frames [DN].
float noise_of(const Comparison& comparison) {
  std::vector<float> sizes;
  sizes.reserve(comparison.difference.size());
  for (const float d : comparison.difference) sizes.push_back(std::abs(d));
  return std::max(0.41F, 1.4826F * median(sizes));
}

float mean_around(const std::vector<float>& values, const Comparison& in, int r, int c) {
  float sum = 0;
  int count = 0;
  for (int y = std::max(0, r - 1); y <= std::min(in.rows - 1, r + 1); ++y) {
    for (int x = std::max(0, c - 1); x <= std::min(in.cols - 1, c + 1); ++x) {
      sum += values[in.index(y, x)];
      ++count;
    }
  }
  return sum / static_cast<float>(count);
}

}  // namespace

Image8 mean_of(ImageView8 first, ImageView8 second) {
  check_pair(first, second);
  Image8 result(first.rows, first.cols, first.channels);
  for (int r = 0; r < result.rows; ++r) {
    const std::uint8_t* a = first.row(r);
    const std::uint8_t* b = second.row(r);
    std::uint8_t* out = result.row(r);
    for (int i = 0; i < result.cols * result.channels; ++i) {
      const bool clipped = a[i] == 255 || b[i] == 255;
      // Halves are rounded up and down in turn, so that the mean of many pixels stays true.
      out[i] = clipped ? std::uint8_t{255}
                       : static_cast<std::uint8_t>((a[i] + b[i] + ((r + i) & 1)) / 2);
    }
  }
  return result;
}

Image8 moving_pixels(ImageView8 first, ImageView8 second) {
  check_pair(first, second);
  Image8 moving(first.rows, first.cols);
  if (first.empty()) return moving;
  const Comparison comparison = compare(first, second);
  const float least =
      6 * noise_of(comparison) / 3;  // the mean of 9 pixels has a third of the noise
  for (int r = 0; r < moving.rows; ++r) {
    for (int c = 0; c < moving.cols; ++c) {
      const float change = std::abs(mean_around(comparison.difference, comparison, r, c));
      const float level = comparison.level[comparison.index(r, c)];
      moving.row(r)[c] = change > least + 0.03F * level ? 255 : 0;
    }
  }
  return moving;
}

}  // namespace facula
