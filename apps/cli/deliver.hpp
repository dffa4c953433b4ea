// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>

#include <filesystem>
#include <string>

namespace facula {

/// Writes text to standard output. Throws Error when that takes it not whole.
void print(const std::string& text);

/// Prints the figures; with `json` also writes them there, or prints them as JSON where it is "-".
void deliver(const Figures& figures, const std::filesystem::path& json);

}  // namespace facula
