// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/deflated.hpp>
#include <facula/map/map_file.hpp>
#include <facula/tests/map/random_scans.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

OccupancyOptions odd_options() {
  return {.resolution = 0.07,
          .max_range = 1.9,
          .hit = 0.73,
          .miss = 0.41,
          .clamp_min = 0.1,
          .clamp_max = 0.98,
          .discretize = true,
          .weigh_sigma = true,
          .box = MapBox{{-1, -2, -3}, {11, 12, 3}}};
}

ScanMap sample_scans(const OccupancyOptions& options, std::size_t count = 3) {
  ScanMap scans(options);
  Random random(2);
  for (std::size_t i = 0; i < count; ++i) {
    scans.add("scan " + std::to_string(i), random_scan(i, 400), random_pose(random));
  }
  return scans;
}

std::string written(const ScanMap& scans) {
  const TemporaryFolder folder;
  write_map_file(folder / "map.fmap", scans.map(), scans.scans());
  return read_whole_file(folder / "map.fmap");
}

MapFile parse(const std::string& bytes) {
  return parse_map_file(bytes_of_text(bytes), "map.fmap");
}

void expect_same_scans(std::span<const KeptScan> a, std::span<const KeptScan> b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].record.name, b[i].record.name);
    EXPECT_EQ(a[i].record.points, b[i].record.points);
    EXPECT_EQ(a[i].record.world_from_scan.matrix(), b[i].record.world_from_scan.matrix());
    EXPECT_EQ(a[i].record.cast.resolution, b[i].record.cast.resolution);
    EXPECT_EQ(a[i].record.cast.max_range, b[i].record.cast.max_range);
    EXPECT_EQ(a[i].record.cast.discretize, b[i].record.cast.discretize);
    EXPECT_EQ(a[i].record.cast.weigh_sigma, b[i].record.cast.weigh_sigma);
    ASSERT_EQ(a[i].record.cast.box.has_value(), b[i].record.cast.box.has_value());
    if (a[i].record.cast.box) {
      EXPECT_EQ(a[i].record.cast.box->max, b[i].record.cast.box->max);
    }
    EXPECT_EQ(a[i].cells.skipped, b[i].cells.skipped);
    EXPECT_TRUE(unpack(a[i].cells).bricks == unpack(b[i].cells).bricks);
  }
}

TEST(MapFile, KeepsTheMapItsOptionsAndItsScansToTheLastBit) {
  for (const OccupancyOptions& options : {OccupancyOptions{.resolution = 0.1}, odd_options()}) {
    const ScanMap scans = sample_scans(options);
    const MapFile back = parse(written(scans));
    EXPECT_TRUE(is_same_map(back.map, scans.map()));
    expect_same_scans(back.scans, scans.scans());
    EXPECT_EQ(back.map.options().hit, options.hit);
    EXPECT_EQ(back.map.options().miss, options.miss);
    EXPECT_EQ(back.map.options().clamp_min, options.clamp_min);
    EXPECT_EQ(back.map.options().clamp_max, options.clamp_max);
    EXPECT_EQ(back.map.options().max_range, options.max_range);
    EXPECT_EQ(back.map.options().discretize, options.discretize);
    EXPECT_EQ(back.map.options().weigh_sigma, options.weigh_sigma);
    EXPECT_EQ(back.map.options().box.has_value(), options.box.has_value());
  }
}

TEST(MapFile, KeepsBricksOfManyValuesOneValueAndOneCell) {
  OccupancyMap map({.resolution = 0.1});
  LogOddsBrick::Values values{};
  CellMask odd;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = std::sin(static_cast<float>(i));
    if (i % 3 == 1) odd.set(i);
  }
  values[7] = -0.0F;
  map.bricks().find_or_add(0).assign(values, CellMask::all());
  map.bricks().find_or_add(5).assign(values, odd);
  map.bricks().find_or_add(6).fill(-0.4F);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 16) - 8;
  map.bricks().find_or_add(7).assign(values, odd);
  CellMask one;
  one.set(511);
  map.bricks().find_or_add((std::uint64_t{1} << 39) - 1).assign(values, one);
  const TemporaryFolder folder;
  map.write(folder / "map.fmap");
  const OccupancyMap back = OccupancyMap::read(folder / "map.fmap");
  EXPECT_TRUE(is_same_map(back, map));
  EXPECT_TRUE(std::signbit(back.bricks().find(0)->value(7).value_or(1)));
}

TEST(MapFile, GoesOnWithScansThatWereKept) {
  ScanMap scans = sample_scans({.resolution = 0.1});
  MapFile file = parse(written(scans));
  ScanMap back(std::move(file.map), std::move(file.scans));
  scans.remove("scan 1");
  back.remove("scan 1");
  EXPECT_TRUE(is_same_map(back.map(), scans.map()));
}

TEST(MapFile, IsReadAndWrittenAsAnyMapIs) {
  const TemporaryFolder folder;
  const ScanMap scans = sample_scans({.resolution = 0.1});
  scans.map().write(folder / "map.fmap");
  EXPECT_TRUE(is_map_file(folder / "map.fmap"));
  std::filesystem::rename(folder / "map.fmap", folder / "map.bt");
  EXPECT_TRUE(is_same_map(OccupancyMap::read(folder / "map.bt"), scans.map()));
  scans.map().write(folder / "map.ot");
  EXPECT_FALSE(is_map_file(folder / "map.ot"));
  EXPECT_FALSE(is_map_file(folder / "none"));
  OccupancyMap({.resolution = 0.3}).write(folder / "empty.fmap");
  const OccupancyMap empty = OccupancyMap::read(folder / "empty.fmap");
  EXPECT_EQ(empty.resolution(), 0.3);
  EXPECT_TRUE(empty.bricks().sorted().empty());
}

TEST(MapFile, IsTheSameForAnyNumberOfThreads) {
  OccupancyOptions options{.resolution = 0.03, .num_threads = 1};
  const std::string one = written(sample_scans(options, 2));
  options.num_threads = 2;
  EXPECT_TRUE(written(sample_scans(options, 2)) == one);
}

TEST(MapFile, FindsEveryTruncation) {
  const std::string whole = written(sample_scans({.resolution = 0.2}));
  for (std::size_t kept = 0; kept < whole.size(); ++kept) {
    const std::string sentence = error_of([&] { parse(whole.substr(0, kept)); });
    EXPECT_NE(sentence.find("'map.fmap'"), std::string::npos) << kept << ": " << sentence;
  }
  EXPECT_NE(error_of([&] { parse(whole + "x"); }).find("1 bytes follow"), std::string::npos);
}

TEST(MapFile, FindsEveryFlippedBit) {
  const std::string whole = written(sample_scans({.resolution = 0.4}, 2));
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    std::string damaged = whole;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ 1 << bit % 8);
    EXPECT_FALSE(error_of([&] { parse(damaged); }).empty()) << "bit " << bit;
  }
}

/// The blocks of a file, opened: kind, bytes before compression.
struct OpenBlock {
  std::uint32_t kind = 0;
  Bytes raw;
};

std::vector<OpenBlock> blocks_of(const std::string& file) {
  std::vector<OpenBlock> blocks;
  ByteReader reader(bytes_of_text(file).subspan(16));
  while (reader.left() > 0) {
    OpenBlock block{.kind = reader.take<std::uint32_t>(), .raw = {}};
    const auto stored_size = reader.take<std::uint32_t>();
    const auto raw_size = reader.take<std::uint32_t>();
    reader.take<std::uint32_t>();
    block.raw = inflated(reader.take_view(stored_size), raw_size);
    blocks.push_back(block);
  }
  return blocks;
}

/// The file of these blocks, with right checksums, by docs/map_files.md.
std::string file_of(const std::string& start, const std::vector<OpenBlock>& blocks) {
  std::string file = start.substr(0, 16);
  for (const OpenBlock& block : blocks) {
    const Bytes stored = deflated(block.raw);
    Bytes bytes;
    put(bytes, block.kind);
    put(bytes, static_cast<std::uint32_t>(stored.size()));
    put(bytes, static_cast<std::uint32_t>(block.raw.size()));
    put(bytes, checksum(stored, checksum(bytes)));
    put_bytes(bytes, stored.data(), stored.size());
    file.append(bytes.begin(), bytes.end());
  }
  return file;
}

TEST(MapFile, SurvivesDamageThatChecksumsDoNotShow) {
  const std::string whole = written(sample_scans({.resolution = 0.4}, 2));
  const std::vector<OpenBlock> blocks = blocks_of(whole);
  ASSERT_EQ(file_of(whole, blocks), whole);
  Random random(3);
  std::size_t refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<OpenBlock> damaged = blocks;
    OpenBlock& block = damaged[random.below(damaged.size())];
    switch (random.below(4)) {
      case 0:
        block.raw.resize(random.below(block.raw.size() + 1));
        break;
      case 1:
        block.raw.push_back(0);
        break;
      case 2:
        std::swap(block, damaged[random.below(damaged.size())]);
        break;
      default:
        block.raw[random.below(block.raw.size())] = static_cast<std::uint8_t>(random.below(256));
    }
    try {
      MapFile file = parse(file_of(whole, damaged));
      file.map.statistics();
      ScanMap scans(std::move(file.map), std::move(file.scans));
      while (!scans.scans().empty()) scans.remove(scans.scans().front().record.name);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1500U);
}

TEST(MapFile, AsksForNoMoreMemoryThanItsBlocksMayHold) {
  std::string file = written(sample_scans({.resolution = 0.4}, 1)).substr(0, 16);
  Bytes block;
  put(block, std::uint32_t{0x4b435242});
  put(block, std::uint32_t{0});
  put(block, std::uint32_t{0xffffffff});
  put(block, checksum(block));
  file.append(block.begin(), block.end());
  EXPECT_NE(error_of([&] { parse(file); }).find("declares 4294967295 bytes"), std::string::npos);
}

TEST(MapFile, SaysWhatIsWrongWithForeignFiles) {
  EXPECT_NE(error_of([&] { parse("# Octomap OcTree file\n"); }).find("'FACUMAP'"),
            std::string::npos);
  EXPECT_NE(error_of([&] { parse(""); }).find("'FACUMAP'"), std::string::npos);
  Bytes start;
  put_bytes(start, "FACUMAP\n", 8);
  put(start, std::uint32_t{9});
  put(start, checksum(start));
  EXPECT_NE(error_of([&] { parse(std::string(start.begin(), start.end())); }).find("version 9"),
            std::string::npos);
  EXPECT_FALSE(error_of([&] { read_map_file("none.fmap"); }).empty());
}

TEST(MapFile, HoldsTheFreiburgCorridorInLessThanItsOtFile) {
  FACULA_REQUIRE_REAL_DATA(path, "range/octomap-maps/geb079.bt");
  const TemporaryFolder folder;
  const OccupancyMap map = OccupancyMap::read(path);
  map.write(folder / "map.fmap");
  map.write(folder / "map.ot");
  EXPECT_TRUE(is_same_map(OccupancyMap::read(folder / "map.fmap"), map));
  EXPECT_LT(5 * std::filesystem::file_size(folder / "map.fmap"),
            std::filesystem::file_size(folder / "map.ot"));
}

}  // namespace
}  // namespace facula
