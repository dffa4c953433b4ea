// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>

#include <filesystem>

namespace facula {

/// Reads rig.toml. Throws Error on a missing file, a syntax error (with its line), an unknown key
/// (with the nearest known one), a missing or absurd value.
Rig read_rig(const std::filesystem::path& path);

/// Writes rig.toml with full precision; read_rig() gives back the same rig.
void write_rig(const std::filesystem::path& path, const Rig& rig);

}  // namespace facula
