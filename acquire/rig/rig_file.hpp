// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/rig.hpp>

#include <filesystem>
#include <string>

namespace facula {

/// Reads rig.toml. Throws Error on a missing file, a syntax error (with its line), an unknown key
/// (with the nearest known one), a missing or absurd value.
Rig read_rig(const std::filesystem::path& path, RigParts needed = RigParts::kWhole);

/// The same from the text of such a file; `source` is what complaints call it.
Rig parse_rig(const std::string& text, const std::string& source);

/// The text that write_rig() writes.
std::string rig_text(const Rig& rig, RigParts needed = RigParts::kWhole);

/// Writes rig.toml with full precision; read_rig() gives back the same rig.
void write_rig(const std::filesystem::path& path,
               const Rig& rig,
               RigParts needed = RigParts::kWhole);

}  // namespace facula
