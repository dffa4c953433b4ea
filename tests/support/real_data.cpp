// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/support/real_data.hpp>

#include <cstdlib>

namespace facula {

std::optional<std::filesystem::path> real_data(const std::string& set) {
  const char* chosen = std::getenv("FACULA_REAL_DATA");
  const std::filesystem::path folder = chosen != nullptr ? chosen : FACULA_REAL_DATA_DEFAULT;
  const std::filesystem::path path = folder / set;
  if (!std::filesystem::exists(path)) return std::nullopt;
  return path;
}

std::filesystem::path shipped_data(const std::string& name) {
  return std::filesystem::path(FACULA_SHIPPED_DATA) / name;
}

}  // namespace facula
