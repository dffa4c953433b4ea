// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace facula {

/// A grey picture as map servers read it.
struct GridImage {
  int rows = 0;
  int cols = 0;
  std::vector<std::uint8_t> grey;   ///< row by row from the top, 255 is white
  std::vector<std::uint8_t> alpha;  ///< 255 is opaque; empty where all are

  std::size_t size() const {
    return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
  }
  bool opaque(std::size_t i) const { return alpha.empty() || alpha[i] == 255; }
};

/// Binary PGM ("P5"), without alpha.
void write_pgm(std::ostream& out, const GridImage& image);

/// PNG with red, green, blue and alpha, which is what nav2's map saver writes.
void write_png(std::ostream& out, const GridImage& image);

/// Reads .pgm, else whatever OpenCV reads; colours become their mean. Throws Error when the file is
/// missing, torn, or has other than 8 bits a channel.
GridImage read_grid_image(const std::filesystem::path& path);

/// The part of read_grid_image() for files other than .pgm.
GridImage decode_grid_image(const std::string& bytes, const std::string& name);

}  // namespace facula
