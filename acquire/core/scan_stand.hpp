// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace facula {

/// How scans stand to each other: what is true between any two scans of which the same is said.
/// Only who set the scanner up knows; a pan head is not plumb for being a pan head, and an object
/// on a turntable may have been turned over between two scans.
enum class ScanStand : std::uint8_t {
  kFree,     ///< nothing is known
  kUpright,  ///< the z axes of the scans' frames are parallel: heads that pan about a plumb axis
  kTable     ///< and no scan is higher than another: an object that stands on a turntable as before
};

/// "free", "upright" or "table", and back; nothing for another word.
const char* to_string(ScanStand stand);
std::optional<ScanStand> stand_from_name(std::string_view name);

}  // namespace facula
