// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace facula {

/// Unpacks one block of Marc Lehmann's LZF format, as binary_compressed PCD files hold it. Nothing
/// when the block is torn or does not unpack to exactly `size` bytes; a size that no block of that
/// length can reach is refused before memory is taken.
std::optional<std::string> unpack_lzf(std::string_view packed, std::size_t size);

}  // namespace facula
