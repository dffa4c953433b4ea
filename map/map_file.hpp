// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/map/scan_map.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace facula {

/// What a Facula map file (.fmap) holds: the map to the last bit with its options, and the scans
/// that made it, where they were kept. docs/map_files.md has the layout.
struct MapFile {
  OccupancyMap map;
  std::vector<KeptScan> scans;
};

/// Writes a .fmap file, whole or not at all; the same bytes for any number of threads.
void write_map_file(const std::filesystem::path& path,
                    const OccupancyMap& map,
                    std::span<const KeptScan> scans = {});

/// Throws Error when the file is missing, is none, is of a later version, torn or damaged: every
/// block has a checksum, and sizes are held against the file's before memory is asked for.
MapFile read_map_file(const std::filesystem::path& path);

/// The same from memory; `name` is the file's name for messages.
MapFile parse_map_file(ByteView file, const std::string& name);

/// Whether a file begins as a .fmap file does; false when there is none.
bool is_map_file(const std::filesystem::path& path);

}  // namespace facula
