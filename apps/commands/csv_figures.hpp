// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>

#include <filesystem>

namespace facula {

/// A table of figures as a file: the columns' keys, units included, then a line per row with all
/// digits; whole or not at all.
void write_table_csv(const std::filesystem::path& path, const FigureTable& table);

}  // namespace facula
