// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/lzf.hpp>

#include <cstdint>

namespace facula {
namespace {

/// The longest copy (264 bytes) is spelled by 3 bytes, so no block grows more than 88-fold.
constexpr std::size_t kLargestGrowth = 88;

/// The next byte of the block, or 0 with `torn` set.
std::size_t take_byte(std::string_view& packed, bool& torn) {
  if (packed.empty()) {
    torn = true;
    return 0;
  }
  const auto byte = static_cast<std::uint8_t>(packed.front());
  packed.remove_prefix(1);
  return byte;
}

}  // namespace

std::optional<std::string> unpack_lzf(std::string_view packed, std::size_t size) {
  if (size / kLargestGrowth > packed.size()) return std::nullopt;
  std::string result;
  result.reserve(size);
  bool torn = false;
  while (!packed.empty()) {
    const std::size_t control = take_byte(packed, torn);
    if (control < 32) {  // a run of control + 1 plain bytes
      const std::size_t length = control + 1;
      if (length > packed.size() || length > size - result.size()) return std::nullopt;
      result.append(packed.substr(0, length));
      packed.remove_prefix(length);
      continue;
    }
    std::size_t length = control >> 5U;  // a copy from what was unpacked before
    if (length == 7) length += take_byte(packed, torn);
    length += 2;
    const std::size_t distance = ((control & 31U) << 8U) + take_byte(packed, torn) + 1;
    if (torn || distance > result.size() || length > size - result.size()) return std::nullopt;
    // Byte by byte: the copy may overlap what it writes.
    for (std::size_t i = 0; i < length; ++i) result.push_back(result[result.size() - distance]);
  }
  if (result.size() != size) return std::nullopt;
  return result;
}

}  // namespace facula
