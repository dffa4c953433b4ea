// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <fstream>
#include <map>
#include <memory>
#include <sstream>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A small map with free, occupied, unsure and pruned cells.
OccupancyMap sample_map(double resolution = 0.1) {
  OccupancyMap map({.resolution = resolution});
  Random random(4);
  for (int scan = 0; scan < 3; ++scan) {
    PointCloud cloud;
    for (int i = 0; i < 3000; ++i) {
      cloud.points.emplace_back(static_cast<float>(random.uniform() * 4 - 2),
                                static_cast<float>(random.uniform() * 2 - 1),
                                1.5F);
      cloud.sensor_origin.emplace_back(0.01F, 0.01F, -0.49F);
    }
    map.insert(cloud);
  }
  return map;
}

std::string bytes_of(const octomap::OcTree& tree) {
  std::ostringstream bytes;
  tree.write(bytes);
  return bytes.str();
}

/// As OctoMap writes the map.
std::string bytes_of(const OccupancyMap& map) {
  return bytes_of(*to_octomap(map));
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  return bytes.str();
}

/// Reading fails with a sentence, and OctoMap prints nothing about it.
std::string silent_error(const std::filesystem::path& path) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::string sentence = error_of([&] { OccupancyMap::read(path); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  return sentence;
}

TEST(OctreeFile, WritesTheOtFileThatOctoMapWrites) {
  const TemporaryFolder folder;
  const OccupancyMap map = sample_map();
  map.write(folder / "map.ot");
  EXPECT_TRUE(bytes_of(folder / "map.ot") == bytes_of(map));
}

TEST(OctreeFile, ReadsBackEveryValueOfAnOtFile) {
  const TemporaryFolder folder;
  for (const double resolution : {0.1, 1.0 / 30, 0.0123456789}) {
    const OccupancyMap map = sample_map(resolution);
    map.write(folder / "map.ot");
    const OccupancyMap back = OccupancyMap::read(folder / "map.ot");
    EXPECT_EQ(back.resolution(), resolution);
    EXPECT_TRUE(bytes_of(back) == bytes_of(map));
  }
}

TEST(OctreeFile, WritesABtFileThatOctoMapReadsWithTheSameCells) {
  const TemporaryFolder folder;
  const OccupancyMap map = sample_map();
  const std::string before = bytes_of(map);
  map.write(folder / "map.bt");
  EXPECT_TRUE(bytes_of(map) == before) << "writing .bt changed the map";
  octomap::OcTree read(1.0);
  ASSERT_TRUE(read.readBinary((folder / "map.bt").string()));
  EXPECT_EQ(read.getResolution(), 0.1);
  std::size_t compared = 0;
  octomap::OcTree cells(*to_octomap(map));
  cells.expand();
  for (auto leaf = cells.begin_leafs(), end = cells.end_leafs(); leaf != end; ++leaf, ++compared) {
    const auto* node = read.search(leaf.getKey());
    ASSERT_NE(node, nullptr);
    ASSERT_EQ(read.isNodeOccupied(node), cells.isNodeOccupied(*leaf));
  }
  EXPECT_GT(compared, 5000U);
  read.expand();
  EXPECT_EQ(read.getNumLeafNodes(), compared) << "cells appeared that the map does not have";
}

TEST(OctreeFile, WritesTheBtFileThatOctoMapWrites) {
  const TemporaryFolder folder;
  const OccupancyMap map = sample_map();
  map.write(folder / "ours.bt");
  octomap::OcTree copy(*to_octomap(map));
  ASSERT_TRUE(copy.writeBinary((folder / "theirs.bt").string()));
  EXPECT_TRUE(bytes_of(folder / "ours.bt") == bytes_of(folder / "theirs.bt"));
}

TEST(OctreeFile, ReadsBtFilesWithTheSameStates) {
  const TemporaryFolder folder;
  const OccupancyMap map = sample_map();
  map.write(folder / "map.bt");
  const OccupancyMap back = OccupancyMap::read(folder / "map.bt");
  const MapStatistics expected = map.statistics();
  EXPECT_EQ(back.statistics().free_cells, expected.free_cells);
  EXPECT_EQ(back.statistics().occupied_cells, expected.occupied_cells);
  map.for_each_leaf([&](const Eigen::Vector3d& centre, CellState state, double) {
    ASSERT_EQ(back.state(centre), state);
  });
}

TEST(OctreeFile, WritesAndReadsWithoutAWord) {
  const TemporaryFolder folder;
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  for (const char* name : {"map.ot", "map.bt"}) {
    sample_map().write(folder / name);
    OccupancyMap::read(folder / name);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST(OctreeFile, KeepsAnEmptyMap) {
  const TemporaryFolder folder;
  for (const char* name : {"empty.ot", "empty.bt"}) {
    OccupancyMap({.resolution = 0.2}).write(folder / name);
    const OccupancyMap back = OccupancyMap::read(folder / name);
    EXPECT_EQ(back.statistics().nodes, 0U);
    EXPECT_EQ(back.resolution(), 0.2);
    const std::unique_ptr<octomap::AbstractOcTree> foreign(
        std::string(name) == "empty.ot" ? octomap::AbstractOcTree::read((folder / name).string())
                                        : nullptr);
    if (foreign != nullptr) {
      EXPECT_EQ(foreign->size(), 0U);
    }
  }
}

TEST(OctreeFile, ContinuesAMapThatWasRead) {
  const TemporaryFolder folder;
  OccupancyMap map = sample_map();
  map.write(folder / "map.ot");
  OccupancyMap back = OccupancyMap::read(folder / "map.ot");
  PointCloud cloud;
  cloud.points.emplace_back(1.5F, 0.3F, 1.2F);
  cloud.sensor_origin.emplace_back(0, 0, 0);
  map.insert(cloud);
  back.insert(cloud);
  EXPECT_TRUE(bytes_of(back) == bytes_of(map));
}

TEST(OctreeFile, FindsEveryTornFile) {
  const TemporaryFolder folder;
  for (const char* name : {"map.ot", "map.bt"}) {
    sample_map(0.4).write(folder / name);
    const std::string whole = bytes_of(folder / name);
    std::size_t kept = 0;
    while (kept < whole.size()) {
      const auto path = folder.write(std::string("torn") + name, whole.substr(0, kept));
      EXPECT_FALSE(silent_error(path).empty()) << kept << " of " << whole.size();
      kept += kept < 200 || whole.size() - kept < 20 ? 1 : 37;
    }
    EXPECT_NE(silent_error(folder.write("long.ot", whole + "x")).find("1 bytes more"),
              std::string::npos);
  }
}

TEST(OctreeFile, SurvivesFlippedBytes) {
  const TemporaryFolder folder;
  sample_map(0.4).write(folder / "map.bt");
  sample_map(0.4).write(folder / "map.ot");
  Random random(1);
  for (const char* name : {"map.ot", "map.bt"}) {
    const std::string whole = bytes_of(folder / name);
    for (int trial = 0; trial < 300; ++trial) {
      std::string damaged = whole;
      damaged[random.below(damaged.size())] = static_cast<char>(random.below(256));
      try {
        OccupancyMap::read(folder.write("damaged", damaged)).statistics();
      } catch (const Error&) {
        // A sentence is as good as a map: a flipped value is not always visible.
      }
    }
  }
}

TEST(OctreeFile, SaysWhatIsWrongWithForeignFiles) {
  const TemporaryFolder folder;
  const std::string start = "# Octomap OcTree file\n";
  const std::map<std::string, std::string> cases = {
      {"ply\nformat ascii 1.0\n", "not an OctoMap file"},
      {"", "not an OctoMap file"},
      {start + "id OcTreeStamped\nsize 3\nres 0.1\ndata\n", "OcTreeStamped"},
      {start + "id OcTree\nsize many\nres 0.1\ndata\n", "many"},
      {start + "id OcTree\nsize 1\nres -0.1\ndata\n", "resolution"},
      {start + "id OcTree\nsize 1\nres nan\ndata\n", "resolution"},
      {start + "id OcTree\nsize 1\nres 1e300\ndata\n", "at most 1e+09 m"},
      {start + "id OcTree\nsize 1\ndata\n", "resolution"},
      {start + "size 1\nres 0.1\ndata\n", "'id'"},
      {start + "id OcTree\nsize 1\nres 0.1\n", "'data'"},
      {start + "id OcTree\nsize 99999999999\nres 0.1\ndata\nabcde", "torn"},
      {start + "id OcTree\nsize 1\nres 0.1\ndata\n" + std::string("\0\0\xc0\x7f\0", 5), "number"},
      {"# Octomap OcTree binary file\nid OcTree\nsize 1\nres 1\ndata\n" + std::string(2, '\0'),
       "no children"},
      {"# Octomap OcTree binary file\nid OcTree\nsize 9\nres 1\ndata\n" + std::string(99, '\3'),
       "deeper"}};
  for (const auto& [text, expected] : cases) {
    const std::string sentence = silent_error(folder.write("map.bt", text));
    EXPECT_NE(sentence.find(expected), std::string::npos) << sentence;
  }
  EXPECT_NE(silent_error(folder / "none.bt").find("no such file"), std::string::npos);
  EXPECT_NE(silent_error(folder.path()).find("it is not a file"), std::string::npos);
}

TEST(OctreeFile, SaysWhereItCannotWrite) {
  const TemporaryFolder folder;
  const OccupancyMap map = sample_map(0.5);
  EXPECT_NE(error_of([&] { map.write(folder / "none" / "map.ot"); }).find("cannot write"),
            std::string::npos);
  EXPECT_NE(error_of([&] { map.write(folder / "map.pcd"); }).find(".bt"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(OctreeFile, ReadsTheFreiburgMapWithTheLeavesItsAuthorsCount) {
  FACULA_REQUIRE_REAL_DATA(path, "range/octomap-maps/geb079.bt");
  const OccupancyMap map = OccupancyMap::read(path);
  std::size_t free = 0;
  std::size_t occupied = 0;
  double free_volume = 0;
  double occupied_volume = 0;
  map.for_each_leaf([&](const Eigen::Vector3d&, CellState state, double edge) {
    ++(state == CellState::kFree ? free : occupied);
    (state == CellState::kFree ? free_volume : occupied_volume) += edge * edge * edge;
  });
  EXPECT_EQ(free, 284415U);
  EXPECT_EQ(occupied, 143729U);
  const MapStatistics statistics = map.statistics();
  EXPECT_EQ(statistics.nodes, 532566U);
  EXPECT_NEAR(free_volume, 486.8, 0.05);
  EXPECT_NEAR(occupied_volume, 95.1, 0.05);
  const double cell = 0.08 * 0.08 * 0.08;
  EXPECT_NEAR(static_cast<double>(statistics.free_cells) * cell, free_volume, 1e-6);
  EXPECT_TRUE(is_near_point(statistics.max - statistics.min, {38.96, 14.96, 3.12}, 0.01));
}

}  // namespace
}  // namespace facula
