// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/deflated.hpp>

#include <zlib.h>

namespace facula {
namespace {

/// The fastest: cells come as words that say little more than they must.
constexpr int kLevel = 1;

}  // namespace

Bytes deflated(ByteView raw) {
  uLongf size = compressBound(static_cast<uLong>(raw.size()));
  Bytes stored(size);
  const int state =
      compress2(stored.data(), &size, raw.data(), static_cast<uLong>(raw.size()), kLevel);
  require(state == Z_OK, "there is no memory to compress ", raw.size(), " bytes");
  stored.resize(size);
  return stored;
}

Bytes inflated(ByteView stored, std::size_t raw_size) {
  Bytes raw(raw_size);
  auto size = static_cast<uLongf>(raw_size);
  const int state = uncompress(raw.data(), &size, stored.data(), static_cast<uLong>(stored.size()));
  require(state == Z_OK && size == raw_size,
          "expected ",
          stored.size(),
          " compressed bytes that stand for ",
          raw_size,
          ", got others");
  return raw;
}

std::uint32_t checksum(ByteView bytes, std::uint32_t before) {
  return static_cast<std::uint32_t>(crc32_z(before, bytes.data(), bytes.size()));
}

}  // namespace facula
