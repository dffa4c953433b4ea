// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>
#include <facula/map/cell_mask.hpp>

#include <cstddef>
#include <cstdint>

namespace facula {

/// What stands for a word of a mask: two bits of a 16-bit number, the lowest for word 0.
enum class MaskWord : unsigned {
  kNone = 0,   ///< no cell
  kAll = 1,    ///< all 64 cells
  kAgain = 2,  ///< the cells of the word before
  kBits = 3    ///< eight bytes follow, in the order of the words
};

/// Appends the 16-bit number and the words that need their bytes: 2 to 66 bytes.
inline void put_mask(Bytes& bytes, const CellMask& mask) {
  unsigned kinds = 0;
  const std::size_t at = bytes.size();
  put(bytes, std::uint16_t{0});
  for (std::size_t i = 0; i < mask.words.size(); ++i) {
    const std::uint64_t word = mask.words[i];
    MaskWord kind = MaskWord::kBits;
    if (word == 0)
      kind = MaskWord::kNone;
    else if (word == ~std::uint64_t{0})
      kind = MaskWord::kAll;
    else if (i > 0 && word == mask.words[i - 1])
      kind = MaskWord::kAgain;
    if (kind == MaskWord::kBits) put(bytes, word);
    kinds |= static_cast<unsigned>(kind) << (2 * i);
  }
  put_at(bytes, at, static_cast<std::uint16_t>(kinds));
}

/// The way back; `reader` remembers when there were too few bytes.
inline CellMask take_mask(ByteReader& reader) {
  CellMask mask;
  const unsigned kinds = reader.take<std::uint16_t>();
  for (std::size_t i = 0; i < mask.words.size(); ++i) {
    switch (static_cast<MaskWord>(kinds >> (2 * i) & 3)) {
      case MaskWord::kNone:
        break;
      case MaskWord::kAll:
        mask.words[i] = ~std::uint64_t{0};
        break;
      case MaskWord::kAgain:
        mask.words[i] = i > 0 ? mask.words[i - 1] : 0;
        break;
      case MaskWord::kBits:
        mask.words[i] = reader.take<std::uint64_t>();
        break;
    }
  }
  return mask;
}

/// Appends a number in as many bytes as it needs, seven bits each, lowest first; the highest bit of
/// a byte says that more follow (LEB128).
inline void put_varint(Bytes& bytes, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) bytes.push_back(static_cast<std::uint8_t>(value | 0x80));
  bytes.push_back(static_cast<std::uint8_t>(value));
}

inline std::uint64_t take_varint(ByteReader& reader) {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    const auto byte = reader.take<std::uint8_t>();
    value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
    if (byte < 0x80) break;
  }
  return value;
}

}  // namespace facula
