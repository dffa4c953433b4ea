// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <algorithm>

namespace facula {

/// A grey image with rows and columns exchanged, block by block, so that neither side is read or
/// written far apart.
inline Image8 transposed(ImageView8 grey) {
  constexpr int kBlock = 16;  // [px]
  Image8 turned(grey.cols, grey.rows);
  for (int r0 = 0; r0 < grey.rows; r0 += kBlock) {
    for (int c0 = 0; c0 < grey.cols; c0 += kBlock) {
      const int rows = std::min(grey.rows, r0 + kBlock);
      const int cols = std::min(grey.cols, c0 + kBlock);
      for (int c = c0; c < cols; ++c) {
        std::uint8_t* to = turned.row(c);
        for (int r = r0; r < rows; ++r) to[r] = grey.row(r)[c];
      }
    }
  }
  return turned;
}

}  // namespace facula
