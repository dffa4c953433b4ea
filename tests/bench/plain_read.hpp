// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>

namespace facula {

/// Sum of all bytes with the widest instructions of this processor, four vectors at a time: what
/// reading this memory costs.
std::uint64_t plain_read(const std::uint8_t* bytes, std::size_t count);

}  // namespace facula
