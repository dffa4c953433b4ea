// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace facula {

/// The bytes of a file. Throws Error when it is missing, is a folder, or cannot be read.
std::string read_whole_file(const std::filesystem::path& path);

/// The extension in lower case with its dot (".ply"); empty when there is none.
std::string lower_extension(const std::filesystem::path& path);

}  // namespace facula
