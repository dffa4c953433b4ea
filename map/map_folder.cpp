// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/deflated.hpp>
#include <facula/map/map_folder.hpp>
#include <facula/map/octree_file.hpp>
#include <facula/map/space_block.hpp>

#include <fstream>
#include <sstream>
#include <string>
#include <utility>

namespace facula {
namespace {

/// The bytes of a block's file, which are those that the index has seen.
std::string read_block_bytes(const std::filesystem::path& path, const BlockRecord& record) {
  std::error_code unknown;
  require(std::filesystem::is_regular_file(path, unknown),
          "the map is incomplete: its index names '",
          path.string(),
          "', which is not there; copy the whole folder");
  const auto size = std::filesystem::file_size(path, unknown);
  require(!unknown && size == record.size,
          "'",
          path.string(),
          "' holds ",
          size,
          " bytes where the map's index has ",
          record.size,
          "; copy the folder again");
  std::string bytes = read_whole_file(path);
  require(checksum(bytes_of_text(bytes)) == record.checksum,
          "'",
          path.string(),
          "' is damaged: its checksum is not that of the map's index; copy the folder again");
  return bytes;
}

/// Moves the bricks of a block's file into the map.
void add_block(const std::filesystem::path& path, const BlockRecord& record, OccupancyMap& map) {
  OctreeContent content = parse_octree(
      read_block_bytes(path, record), map.options().model(), path.string(), kBricksPerBlock);
  require(content.resolution == map.resolution(),
          "'",
          path.string(),
          "' has cells of ",
          content.resolution,
          " m, the map has cells of ",
          map.resolution(),
          " m");
  const auto entries = content.map.entries();
  require(entries.size() == record.bricks,
          "'",
          path.string(),
          "' holds ",
          entries.size(),
          " bricks where the map's index has ",
          record.bricks);
  for (const LogOddsMap::Entry& entry : entries) {
    require(block_of(entry.code) == record.block,
            "'",
            path.string(),
            "' holds cells outside its block");
    map.bricks().find_or_add(entry.code) = std::move(content.map.find_or_add(entry.code));
  }
}

}  // namespace

BlockRecord write_block(const std::filesystem::path& folder,
                        std::uint64_t block,
                        const LogOddsMap& bricks,
                        double resolution) {
  std::ostringstream text;
  write_ot(text, bricks, resolution);
  const std::string bytes = std::move(text).str();
  AtomicFile file(folder / block_file_name(block));
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
  return {.block = block,
          .size = bytes.size(),
          .checksum = checksum(bytes_of_text(bytes)),
          .bricks = bricks.sorted().size()};
}

bool is_block_index(const std::filesystem::path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_regular_file(path, unknown)) return false;
  constexpr std::string_view kMark = "facula map in blocks ";
  std::string start(kMark.size(), '\0');
  std::ifstream(path, std::ios::binary)
      .read(start.data(), static_cast<std::streamsize>(start.size()));
  return start == kMark;
}

OccupancyMap read_map_folder(const std::filesystem::path& index) {
  const BlockIndex content = parse_block_index(read_whole_file(index), index.string());
  OccupancyMap map(content.options);
  for (const BlockRecord& record : content.blocks) {
    add_block(index.parent_path() / block_file_name(record.block), record, map);
  }
  return map;
}

}  // namespace facula
