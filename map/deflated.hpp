// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>

#include <cstddef>
#include <cstdint>

namespace facula {

/// Compressed by zlib (RFC 1950).
Bytes deflated(ByteView raw);

/// The way back. Throws Error unless the bytes are whole and stand for exactly `raw_size` bytes;
/// never makes room for more.
Bytes inflated(ByteView stored, std::size_t raw_size);

/// CRC-32 as zlib and PNG have it (polynomial 0xEDB88320); `before` continues over what came first.
std::uint32_t checksum(ByteView bytes, std::uint32_t before = 0);

}  // namespace facula
