// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/block_index.hpp>
#include <facula/map/log_odds_map.hpp>

#include <cstdint>
#include <filesystem>

namespace facula {

// A map too large for one file, or for the memory of one machine: a folder with an OctoMap .ot file
// for every block of space that holds something, and an index of them.

/// The index's name in its folder.
constexpr const char* kBlockIndexName = "map.blocks";

/// Writes the file of one block, whole or not at all. `bricks` are those of that block, at least
/// one of them known.
BlockRecord write_block(const std::filesystem::path& folder,
                        std::uint64_t block,
                        const LogOddsMap& bricks,
                        double resolution);

/// Whether a file begins as an index does; false when there is none.
bool is_block_index(const std::filesystem::path& path);

/// Reads the whole map that an index describes, to the last bit. Throws Error when the index or a
/// block's file is missing, torn, damaged or of another map.
OccupancyMap read_map_folder(const std::filesystem::path& index);

}  // namespace facula
