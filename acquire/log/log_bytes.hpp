// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>

#include <cstdint>

namespace facula {

/// CRC-32 as zlib, PNG and Ethernet have it (polynomial 0xEDB88320).
std::uint32_t crc32_of(ByteView bytes);

}  // namespace facula
