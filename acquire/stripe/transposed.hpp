// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <algorithm>

namespace facula {

/// An image with rows and columns exchanged, block by block, so that neither side is read or
/// written far apart.
template <int kChannels>
Image8 transposed_as(ImageView8 image) {
  constexpr int kBlock = 32;  // [px]
  Image8 turned(image.cols, image.rows, kChannels);
  const std::ptrdiff_t across = turned.stride();
  for (int r0 = 0; r0 < image.rows; r0 += kBlock) {
    for (int c0 = 0; c0 < image.cols; c0 += kBlock) {
      const int rows = std::min(image.rows, r0 + kBlock);
      const int cols = std::min(image.cols, c0 + kBlock);
      for (int r = r0; r < rows; ++r) {
        const std::uint8_t* from = image.row(r) + c0 * kChannels;
        std::uint8_t* to = turned.row(c0) + r * kChannels;
        for (int c = c0; c < cols; ++c, from += kChannels, to += across) {
          for (int k = 0; k < kChannels; ++k) to[k] = from[k];
        }
      }
    }
  }
  return turned;
}

inline Image8 transposed(ImageView8 image) {
  return image.channels == 3 ? transposed_as<3>(image) : transposed_as<1>(image);
}

}  // namespace facula
