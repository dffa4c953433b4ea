// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace facula {

/// The rows of a CSV file of data/tables by column name; lines that begin with # are comments, and
/// cells that are no number are left out. Throws Error when the file is missing.
std::vector<std::map<std::string, double>> read_table(const std::filesystem::path& path);

}  // namespace facula
