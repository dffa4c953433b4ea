// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>

namespace octomap {
class OcTree;
}

namespace facula {

/// Reads OctoMap's .ot or .bt. Everything is checked before OctoMap sees it, since OctoMap itself
/// prints to stderr and takes a torn file for a smaller map. Throws Error.
std::unique_ptr<octomap::OcTree> read_octree(const std::filesystem::path& path);

/// Writes .ot (every log-odds value) or .bt (free or occupied, from a copy), by the extension.
/// Throws Error on another extension or where the file cannot be written.
void write_octree(const std::filesystem::path& path, const octomap::OcTree& tree);

}  // namespace facula
