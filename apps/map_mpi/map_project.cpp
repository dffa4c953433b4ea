// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/apps/map_mpi/map_project.hpp>
#include <facula/apps/map_mpi/rank_map.hpp>
#include <facula/map/map_folder.hpp>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace facula {
namespace {

static_assert(std::is_trivially_copyable_v<BlockRecord> &&
              std::is_trivially_copyable_v<RankFigures>);

/// The items of all ranks, by rank, on the first rank; nothing on the others.
template <typename Item>
std::vector<Item> gathered(const std::vector<Item>& mine, const Ranks& ranks) {
  std::vector<Bytes> parts(ranks.size());
  put_bytes(parts[0], mine.data(), mine.size() * sizeof(Item));
  std::vector<Item> all;
  for (const Bytes& part : ranks.exchange(parts)) {
    ByteReader reader(part);
    while (reader.left() > 0) {
      all.emplace_back();
      reader.take_bytes(&all.back(), sizeof(Item));
    }
  }
  return all;
}

/// The first rank's text, on all ranks.
std::string broadcast(const std::string& text, const Ranks& ranks) {
  const Bytes bytes(text.begin(), text.end());
  const std::vector<Bytes> parts(ranks.size(), ranks.first() ? bytes : Bytes());
  const Bytes received = ranks.exchange(parts)[0];
  return {received.begin(), received.end()};
}

/// The scans, on all ranks; what all would find wrong the first one says.
std::vector<ListedScan> list_on_all(const std::vector<std::filesystem::path>& paths,
                                    const Ranks& ranks) {
  std::vector<ListedScan> scans;
  for (const bool first : {true, false}) {
    ranks.together([&] {
      if (ranks.first() == first) scans = list_posed_scans(paths);
    });
  }
  return scans;
}

/// Makes the folder on the first rank and holds that the others see it.
std::filesystem::path open_folder(const MapProject& project,
                                  const Ranks& ranks,
                                  std::optional<OutputFolder>& folder) {
  ranks.together([&] {
    if (ranks.first()) folder.emplace(project.out, kBlockIndexName, project.overwrite);
  });
  std::filesystem::path path =
      broadcast(folder ? std::filesystem::absolute(folder->temporary_path()).string() : "", ranks);
  ranks.together([&] {
    require(std::filesystem::is_directory(path),
            "expected to see the folder '",
            path.string(),
            "' that rank 0 has made, got nothing there; choose an --out on a disk that all "
            "machines share");
  });
  return path;
}

void check_totals(const std::vector<RankFigures>& figures, const MapProject& project) {
  std::uint64_t rays = 0;
  std::uint64_t skipped = 0;
  for (const RankFigures& rank : figures) {
    rays += rank.rays;
    skipped += rank.skipped;
  }
  require(rays > 0,
          "expected points, got none in '",
          project.scans.front().string(),
          "'; was the scan empty?");
  require(skipped < rays,
          "expected points within 32768 cells of the origin, got none at a cell of ",
          1000 * project.options.resolution,
          " mm; choose a larger --resolution-mm, or look at the scan with 'facula info'");
}

void write_index(const std::filesystem::path& folder,
                 const MapProject& project,
                 const std::vector<RankFigures>& figures,
                 std::vector<BlockRecord> blocks) {
  std::sort(blocks.begin(), blocks.end(), [](const BlockRecord& a, const BlockRecord& b) {
    return a.block < b.block;
  });
  BlockIndex index{.options = project.options, .blocks = std::move(blocks)};
  for (const RankFigures& rank : figures) {
    index.scans += rank.scans;
    index.points += rank.rays;
  }
  AtomicFile file(folder / kBlockIndexName);
  file.stream() << block_index_text(index);
  file.commit();
}

}  // namespace

std::vector<RankFigures> map_project(const MapProject& project, const Ranks& ranks) {
  const std::vector<ListedScan> scans = list_on_all(project.scans, ranks);
  std::optional<OutputFolder> folder;
  const std::filesystem::path temporary = open_folder(project, ranks, folder);
  RankMap map(ranks, project.options);
  map.insert(scans);
  std::vector<BlockRecord> records;
  ranks.together([&] { records = map.write(temporary); });
  const std::vector<BlockRecord> blocks = gathered(records, ranks);
  std::vector<RankFigures> figures = gathered(std::vector{map.figures()}, ranks);
  ranks.together([&] {
    if (!ranks.first()) return;
    check_totals(figures, project);
    write_index(temporary, project, figures, blocks);
    folder->commit();
  });
  return figures;
}

}  // namespace facula
