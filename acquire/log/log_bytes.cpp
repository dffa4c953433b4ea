// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/log/log_bytes.hpp>

#include <zlib.h>

namespace facula {

std::uint32_t crc32_of(ByteView bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, bytes.data(), bytes.size()));
}

}  // namespace facula
