// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// An image somebody else owns. Pixel (0, 0) is the centre of the top left pixel; `stride` is the
/// step from one row to the next in elements; channels lie interleaved (3: blue, green, red).
template <typename Element>
struct ImageView {
  const Element* data = nullptr;
  int rows = 0;               ///< [px]
  int cols = 0;               ///< [px]
  int channels = 1;           ///< 1 grey or 3 colour [1]
  std::ptrdiff_t stride = 0;  ///< elements per row, padding included [1]

  const Element* row(int r) const { return data + static_cast<std::ptrdiff_t>(r) * stride; }
  bool empty() const { return rows <= 0 || cols <= 0 || data == nullptr; }
};

using ImageView8 = ImageView<std::uint8_t>;
using ImageView16 = ImageView<std::uint16_t>;

/// An image that owns its pixels, rows without padding.
template <typename Element>
struct Image {
  int rows = 0;      ///< [px]
  int cols = 0;      ///< [px]
  int channels = 1;  ///< 1 grey or 3 colour (blue, green, red) [1]
  std::vector<Element> pixels;

  Image() = default;
  Image(int row_count, int col_count, int channel_count = 1)
      : rows(row_count),
        cols(col_count),
        channels(channel_count),
        pixels(static_cast<std::size_t>(row_count) * static_cast<std::size_t>(col_count) *
               static_cast<std::size_t>(channel_count)) {}

  std::ptrdiff_t stride() const { return static_cast<std::ptrdiff_t>(cols) * channels; }
  Element* row(int r) { return pixels.data() + r * stride(); }
  const Element* row(int r) const { return pixels.data() + r * stride(); }
  bool empty() const { return pixels.empty(); }
  ImageView<Element> view() const { return {pixels.data(), rows, cols, channels, stride()}; }
};

using Image8 = Image<std::uint8_t>;
using Image16 = Image<std::uint16_t>;

}  // namespace facula
