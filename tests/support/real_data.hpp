// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace facula {

/// Folder or file of the real data sets: below FACULA_REAL_DATA, else beside the checkout. None
/// when it is not there; the test then skips itself, naming the set.
std::optional<std::filesystem::path> real_data(const std::string& set);

/// A file this project ships, below data/.
std::filesystem::path shipped_data(const std::string& name);

}  // namespace facula

/// Skips the test by name where the set is not on this machine; otherwise defines `variable`.
#define FACULA_REQUIRE_REAL_DATA(variable, set)                                       \
  const auto variable##_found = facula::real_data(set);                               \
  if (!variable##_found) GTEST_SKIP() << "real data set '" << (set) << "' is absent"; \
  const std::filesystem::path variable = variable##_found.value_or(std::filesystem::path())
