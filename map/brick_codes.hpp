// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/error.hpp>
#include <facula/map/cell_key.hpp>
#include <facula/map/mask_bytes.hpp>

#include <cstdint>

namespace facula {

/// Codes are below this: three bits per level above the bricks [1].
constexpr std::uint64_t kBrickCodeLimit = std::uint64_t{1} << (3 * (kTreeDepth - kBrickLevel));

/// Codes of bricks in ascending order, each as what it adds to the one before.
class BrickCodeWriter {
 public:
  void put(Bytes& bytes, std::uint64_t code) {
    put_varint(bytes, code - next_);
    next_ = code + 1;
  }

 private:
  std::uint64_t next_ = 0;
};

/// The way back.
class BrickCodeReader {
 public:
  /// Throws Error where the code leaves space.
  std::uint64_t take(ByteReader& reader) {
    const std::uint64_t more = take_varint(reader);
    require(more < kBrickCodeLimit - next_, "a brick lies outside the 65536 cells of an axis");
    const std::uint64_t code = next_ + more;
    next_ = code + 1;
    return code;
  }

 private:
  std::uint64_t next_ = 0;
};

}  // namespace facula
