// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/deflated.hpp>
#include <facula/map/map_folder.hpp>
#include <facula/map/space_block.hpp>
#include <facula/tests/map/random_scans.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iomanip>
#include <map>

namespace facula {
namespace {

OccupancyOptions odd_options() {
  return {.resolution = 0.07,
          .max_range = 1.9,
          .hit = 0.73,
          .miss = 1.0 / 3,
          .clamp_min = 0.1,
          .clamp_max = 0.98,
          .discretize = true,
          .weigh_sigma = true};
}

OccupancyMap sample_map(const OccupancyOptions& options) {
  OccupancyMap map(options);
  Random random(2);
  for (std::size_t i = 0; i < 3; ++i) {
    map.insert(transformed(random_scan(i, 300), random_pose(random)));
  }
  return map;
}

/// Writes a map as many ranks would; the index as well.
BlockIndex write_blocks(const std::filesystem::path& folder, const OccupancyMap& map) {
  std::map<std::uint64_t, LogOddsMap> blocks;
  for (const LogOddsMap::Entry* entry : map.bricks().sorted()) {
    LogOddsBrick::Values values{};
    const CellMask known = entry->brick.read(values);
    blocks[block_of(entry->code)].find_or_add(entry->code).assign(values, known);
  }
  BlockIndex index{.options = map.options(), .scans = 3, .points = 900};
  for (const auto& [block, bricks] : blocks) {
    index.blocks.push_back(write_block(folder, block, bricks, map.resolution()));
  }
  std::ofstream(folder / kBlockIndexName) << block_index_text(index);
  return index;
}

std::string sentence_of(const TemporaryFolder& folder) {
  return error_of([&] { OccupancyMap::read(folder / kBlockIndexName); });
}

void expect_words(const std::string& sentence, const std::string& words) {
  EXPECT_NE(sentence.find(words), std::string::npos) << sentence;
}

/// An index of these lines behind the mark, its checksum right.
std::string index_of(const std::string& lines) {
  const std::string text = std::string(kBlockIndexMark) + "\n" + lines;
  std::ostringstream sum;
  sum << std::hex << std::setw(8) << std::setfill('0') << checksum(bytes_of_text(text));
  return text + "checksum " + sum.str() + "\n";
}

std::string lines_of(const std::string& text) {
  const std::size_t begin = text.find('\n') + 1;
  return text.substr(begin, text.rfind("checksum ") - begin);
}

TEST(SpaceBlock, IsNamedByItsPlace) {
  EXPECT_EQ(block_file_name(block_of(brick_code({kCentreKey, kCentreKey - 1, kCentreKey + 128}))),
            "block_256_255_257.ot");
  EXPECT_EQ(block_file_name(0), "block_0_0_0.ot");
  EXPECT_EQ(block_file_name(kBlockLimit - 1), "block_511_511_511.ot");
}

TEST(SpaceBlock, IsDealtToOwnersEvenly) {
  constexpr std::size_t kOwners = 64;
  std::array<int, kOwners> blocks{};
  for (int x = 0; x < 80; ++x) {
    for (int y = 0; y < 80; ++y) {
      const CellKey cell{kCentreKey + 128 * x, kCentreKey + 128 * y, kCentreKey};
      ++blocks[owner_of_block(block_of(brick_code(cell)), kOwners)];
    }
  }
  // 100 each, with a standard deviation of 10 where they fall by chance.
  EXPECT_GT(*std::min_element(blocks.begin(), blocks.end()), 60);
  EXPECT_LT(*std::max_element(blocks.begin(), blocks.end()), 140);
}

TEST(MapFolder, KeepsTheMapAndItsOptionsToTheLastBit) {
  for (const OccupancyOptions& options : {OccupancyOptions{.resolution = 0.1}, odd_options()}) {
    const TemporaryFolder folder;
    const OccupancyMap map = sample_map(options);
    const BlockIndex index = write_blocks(folder.path(), map);
    EXPECT_GT(index.blocks.size(), 3U);
    const OccupancyMap back = OccupancyMap::read(folder / kBlockIndexName);
    EXPECT_TRUE(is_same_map(back, map));
    EXPECT_EQ(ot_bytes(back), ot_bytes(map));
    const BlockIndex read = parse_block_index(block_index_text(index), "map.blocks");
    EXPECT_EQ(read.blocks, index.blocks);
    EXPECT_EQ(read.scans, 3U);
    EXPECT_EQ(read.points, 900U);
    EXPECT_EQ(read.options.resolution, options.resolution);
    EXPECT_EQ(read.options.max_range, options.max_range);
    EXPECT_EQ(read.options.hit, options.hit);
    EXPECT_EQ(read.options.miss, options.miss);
    EXPECT_EQ(read.options.clamp_min, options.clamp_min);
    EXPECT_EQ(read.options.clamp_max, options.clamp_max);
    EXPECT_EQ(read.options.discretize, options.discretize);
    EXPECT_EQ(read.options.weigh_sigma, options.weigh_sigma);
  }
}

TEST(MapFolder, HoldsBlocksThatAreMapsThemselves) {
  const TemporaryFolder folder;
  const OccupancyMap map = sample_map({.resolution = 0.1});
  std::size_t bricks = 0;
  for (const BlockRecord& record : write_blocks(folder.path(), map).blocks) {
    bricks += OccupancyMap::read(folder / block_file_name(record.block)).bricks().entries().size();
  }
  EXPECT_EQ(bricks, map.bricks().sorted().size());
}

TEST(MapFolder, SaysWhatIsMissingOrDamaged) {
  const TemporaryFolder folder;
  const BlockIndex index = write_blocks(folder.path(), sample_map({.resolution = 0.1}));
  const std::string name = block_file_name(index.blocks[1].block);
  const std::string bytes = read_whole_file(folder / name);
  ASSERT_EQ(bytes.size(), index.blocks[1].size);
  std::filesystem::remove(folder / name);
  expect_words(sentence_of(folder), name + "', which is not there");
  folder.write(name, bytes.substr(1));
  expect_words(sentence_of(folder), "bytes where the map's index has");
  std::string flipped = bytes;
  flipped.back() = static_cast<char>(flipped.back() ^ 1);
  folder.write(name, flipped);
  expect_words(sentence_of(folder), name + "' is damaged");
}

TEST(MapFolder, RefusesBlocksOfAnotherMap) {
  const TemporaryFolder folder;
  const OccupancyMap map = sample_map({.resolution = 0.1});
  const BlockIndex index = write_blocks(folder.path(), map);
  const auto refused = [&](const std::function<void(BlockRecord&)>& change) {
    BlockIndex changed = index;
    change(changed.blocks[0]);
    folder.write(kBlockIndexName, block_index_text(changed));
    return sentence_of(folder);
  };
  expect_words(refused([](BlockRecord& record) { ++record.bricks; }), "bricks where the map's");
  LogOddsMap one;
  one.find_or_add(kBricksPerBlock * index.blocks[0].block + 3).fill(1);
  expect_words(refused([&](BlockRecord& record) {
                 record = write_block(folder.path(), record.block, one, 0.2);
               }),
               "cells of 0.2 m, the map has cells of 0.1 m");
  LogOddsMap elsewhere;
  elsewhere.find_or_add(kBricksPerBlock * (index.blocks[0].block + 1)).fill(1);
  expect_words(refused([&](BlockRecord& record) {
                 record = write_block(folder.path(), record.block, elsewhere, 0.1);
               }),
               "holds cells outside its block");
}

TEST(BlockIndex, FindsEveryTruncationAndFlippedBit) {
  const TemporaryFolder folder;
  const std::string whole =
      block_index_text(write_blocks(folder.path(), sample_map(odd_options())));
  const auto sentence = [&](const std::string& text) {
    return error_of([&] { parse_block_index(text, "map.blocks"); });
  };
  for (std::size_t kept = 0; kept < whole.size(); ++kept) {
    expect_words(sentence(whole.substr(0, kept)), "'map.blocks'");
  }
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ 1 << bit % 8);
    // The case of a hexadecimal digit of the checksum is all that may change.
    if (lines_of(damaged) == lines_of(whole) && damaged.starts_with(kBlockIndexMark)) continue;
    expect_words(sentence(damaged), "'map.blocks'");
  }
}

TEST(BlockIndex, RefusesLinesThatNobodyWrote) {
  const TemporaryFolder folder;
  const std::string good =
      lines_of(block_index_text(write_blocks(folder.path(), sample_map({.resolution = 0.1}))));
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string lines = good;
    lines.replace(lines.find(from), from.size(), to);
    return error_of([&] { parse_block_index(index_of(lines), "map.blocks"); });
  };
  ASSERT_NO_THROW(parse_block_index(index_of(good), "map.blocks"));
  expect_words(error_of([] { parse_block_index("facula map in blocks 2\n", "map.blocks"); }),
               "of version '2'");
  expect_words(error_of([] { parse_block_index("", "map.blocks"); }), "no index");
  expect_words(refused("resolution_m 0.1", "resolution_m x"), "line 2: expected 'resolution_m'");
  expect_words(refused("resolution_m 0.1", "resolution_m 0"), "resolution above 0");
  expect_words(refused("hit 0.7", "hit nan"), "expected hit between");
  expect_words(refused("scans 3", "scans -3"), "'scans' and a number");
  expect_words(refused("block_", "../block_"), "expected block_X_Y_Z.ot");
  expect_words(refused("block_", "block_0"), "expected block_X_Y_Z.ot");
  const std::string first = good.substr(
      good.find("block_"), good.find('\n', good.find("block_")) - good.find("block_") + 1);
  expect_words(refused(first, first + first), "stands twice");
  expect_words(refused(first, ""), "announces");
}

}  // namespace
}  // namespace facula
