// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/scan_stand.hpp>

namespace facula {

const char* to_string(ScanStand stand) {
  switch (stand) {
    case ScanStand::kFree:
      return "free";
    case ScanStand::kUpright:
      return "upright";
    case ScanStand::kTable:
      return "table";
  }
  return "free";
}

std::optional<ScanStand> stand_from_name(std::string_view name) {
  for (const ScanStand stand : {ScanStand::kFree, ScanStand::kUpright, ScanStand::kTable}) {
    if (name == to_string(stand)) return stand;
  }
  return {};
}

}  // namespace facula
