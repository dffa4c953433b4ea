// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace facula {

/// Where the scenes, rigs and captures that come with the program lie: the environment variable
/// FACULA_DATA, else share/facula beside the installed program, else the source tree's data.
std::filesystem::path data_folder();

/// The path as typed; when there is nothing and it begins with "data/", the shipped file of that
/// name.
std::filesystem::path resolved_input(const std::string& typed);

}  // namespace facula
