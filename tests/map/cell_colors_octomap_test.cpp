// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/color_tree.hpp>
#include <facula/map/map_file.hpp>
#include <facula/map/map_merge.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/tests/map/random_scans.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>

#include <octomap/ColorOcTree.h>

namespace facula {
namespace {

constexpr double kResolution = 0.2;

PointCloud colored_scan(std::uint64_t seed, std::size_t points = 3000) {
  PointCloud cloud = random_scan(seed, points);
  Random random(100 + seed);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto channel = [&] { return static_cast<std::uint8_t>(random.below(256)); };
    cloud.colors.push_back({channel(), channel(), channel()});
  }
  return cloud;
}

std::map<CellKey, Color> colors_of(const CellColors& colors) {
  std::map<CellKey, Color> result;
  for (const ColorBrick* brick : colors.sorted()) {
    for_each_cell(brick->cells, [&](std::size_t place) {
      const CellKey cell = cell_at(first_cell(brick->code), place);
      result[cell] = colors.color(cell).value_or(Color{});
    });
  }
  return result;
}

bool same_colors(const CellColors& a, const CellColors& b) {
  const auto ours = a.sorted();
  const auto theirs = b.sorted();
  return std::equal(
      ours.begin(), ours.end(), theirs.begin(), theirs.end(), [](const auto* x, const auto* y) {
        return *x == *y;
      });
}

TEST(CellColors, AreTheMeansOfAllPointsThatEndInACell) {
  OccupancyMap map({.resolution = kResolution});
  std::map<CellKey, std::array<double, 4>> sums;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const PointCloud cloud = colored_scan(seed);
    map.insert(cloud);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      auto& sum = sums[cell_of(cloud.points[i].cast<double>(), kResolution).value_or(CellKey{})];
      for (std::size_t c = 0; c < 3; ++c) sum[c] += cloud.colors[i][c];
      sum[3] += 1;
    }
  }
  const std::map<CellKey, Color> found = colors_of(map.colors());
  ASSERT_EQ(found.size(), sums.size());
  for (const auto& [cell, sum] : sums) {
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(found.at(cell)[c], std::floor(sum[c] / sum[3] + 0.5));
    }
  }
  EXPECT_FALSE(map.colors().color({0, 0, 0}).has_value());
  EXPECT_EQ(ColorSum().mean(), Color{});
}

TEST(CellColors, DoNotDependOnTheOrderOfPointsOrScans) {
  const PointCloud first = colored_scan(1);
  std::vector<std::size_t> backwards(first.size());
  std::iota(backwards.rbegin(), backwards.rend(), std::size_t{0});
  OccupancyMap one({.resolution = kResolution});
  OccupancyMap two({.resolution = kResolution});
  one.insert(first);
  one.insert(colored_scan(2));
  two.insert(colored_scan(2));
  two.insert(selected(first, backwards));
  EXPECT_TRUE(same_colors(one.colors(), two.colors()));
}

TEST(CellColors, AreOfTheCellsThatRaysEndedIn) {
  PointCloud cloud = colored_scan(1);
  cloud.points[5].x() = std::nanf("");
  cloud.points[6].x() = 1e9F;
  for (const bool discretize : {false, true}) {
    for (const double max_range : {0.0, 1.2}) {
      for (const bool boxed : {false, true}) {
        CastOptions options{
            .resolution = kResolution, .max_range = max_range, .discretize = discretize};
        if (boxed) options.box = MapBox{{-1, -1, -1}, {1, 0.5F, 1}};
        std::map<std::uint64_t, CellMask> ended;
        for (const ScanBrick& brick : cells_of_scan(cloud, options).bricks) {
          if (!brick.ended.none()) ended[brick.code] = brick.ended;
        }
        std::map<std::uint64_t, CellMask> colored;
        for (const ColorBrick& brick : colors_of_scan(cloud, options)) {
          colored[brick.code] = brick.cells;
        }
        EXPECT_TRUE(colored == ended) << discretize << max_range << boxed;
      }
    }
  }
}

TEST(CellColors, CostNothingWithoutColors) {
  OccupancyMap map({.resolution = kResolution});
  map.insert(random_scan(1, 100));
  EXPECT_TRUE(map.colors().empty());
  EXPECT_EQ(map.colors().memory_usage(), 0U);
}

TEST(CellColors, OfARemovedScanGoWithIt) {
  ScanMap scans({.resolution = kResolution});
  RigidTransform there;
  there.translation = {0.7, 0, 0};
  for (std::uint64_t i = 0; i < 4; ++i) scans.add(std::to_string(i), colored_scan(i), there);
  scans.remove("2");
  const CastOptions cast{.resolution = kResolution};
  scans.replace({"1", {}, 3000, cast},
                cells_of_scan(colored_scan(7), cast),
                colors_of_scan(colored_scan(7), cast));
  OccupancyMap direct({.resolution = kResolution});
  direct.insert(transformed(colored_scan(0), there));
  direct.insert(colored_scan(7));
  direct.insert(transformed(colored_scan(3), there));
  EXPECT_TRUE(is_same_map(scans.map(), direct));
  EXPECT_TRUE(same_colors(scans.map().colors(), direct.colors()));
  for (const char* name : {"0", "1", "3"}) scans.remove(name);
  EXPECT_TRUE(scans.map().colors().empty());
}

TEST(CellColors, StandInMapFilesWithTheirSums) {
  const TemporaryFolder folder;
  ScanMap scans({.resolution = kResolution});
  scans.add("a", colored_scan(1), {});
  scans.add("b", random_scan(2, 100), {});
  scans.add("c", colored_scan(3), {});
  write_map_file(folder / "map.fmap", scans.map(), scans.scans());
  MapFile file = read_map_file(folder / "map.fmap");
  EXPECT_TRUE(same_colors(file.map.colors(), scans.map().colors()));
  ScanMap back(std::move(file.map), std::move(file.scans));
  back.remove("a");
  scans.remove("a");
  EXPECT_TRUE(same_colors(back.map().colors(), scans.map().colors()));
  std::string whole = read_whole_file(folder / "map.fmap");
  for (std::size_t i = 0; i < whole.size(); i += 97) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    EXPECT_FALSE(error_of([&] { parse_map_file(bytes_of_text(damaged), "m"); }).empty());
  }
}

TEST(CellColors, MoveWithTheirCellsInMerges) {
  OccupancyMap source({.resolution = kResolution});
  source.insert(colored_scan(1));
  OccupancyMap target({.resolution = kResolution});
  target.insert(colored_scan(2));
  const std::map<CellKey, Color> before = colors_of(target.colors());
  RigidTransform shift;
  shift.translation = {40 * kResolution, 0, 0};
  merge_map(target, source, shift);
  std::map<CellKey, Color> expected = before;
  for (const auto& [cell, color] : colors_of(source.colors())) {
    expected[{cell[0] + 40, cell[1], cell[2]}] = color;
  }
  EXPECT_TRUE(colors_of(target.colors()) == expected);
}

std::unique_ptr<octomap::ColorOcTree> read_by_octomap(const std::filesystem::path& path) {
  std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(path.string()));
  auto* tree = dynamic_cast<octomap::ColorOcTree*>(any.get());
  if (tree != nullptr) any.release();
  return std::unique_ptr<octomap::ColorOcTree>(tree);
}

Color color_of(const octomap::ColorOcTreeNode& node) {
  return {node.getColor().r, node.getColor().g, node.getColor().b};
}

TEST(ColorOcTreeFile, IsReadByOctoMapWithEveryValueAndColor) {
  const TemporaryFolder folder;
  OccupancyMap map({.resolution = kResolution});
  for (std::uint64_t i = 0; i < 8; ++i) map.insert(colored_scan(i % 3));
  map.write(folder / "map.ot");
  const auto tree = read_by_octomap(folder / "map.ot");
  ASSERT_NE(tree, nullptr);
  octomap::ColorOcTree cells(*tree);
  cells.expand();
  std::size_t colored = 0;
  for (auto leaf = tree->begin_leafs(), end = tree->end_leafs(); leaf != end; ++leaf) {
    const octomap::point3d x = leaf.getCoordinate();
    const Eigen::Vector3d centre(x.x(), x.y(), x.z());
    if (leaf.getDepth() == 16) {
      ASSERT_EQ(map.log_odds(centre).value_or(9), leaf->getLogOdds());
      const auto cell = cell_of(centre, kResolution).value_or(CellKey{});
      ASSERT_EQ(map.colors().color(cell).value_or(kNoColor), color_of(*leaf));
    } else {
      ASSERT_EQ(color_of(*leaf), kNoColor) << "colours of this test differ from cell to cell";
    }
    colored += color_of(*leaf) != kNoColor ? 1 : 0;
  }
  const MapStatistics statistics = map.statistics();
  EXPECT_EQ(cells.getNumLeafNodes(), statistics.free_cells + statistics.occupied_cells);
  EXPECT_EQ(colored, colors_of(map.colors()).size());
}

TEST(ColorOcTreeFile, IsWhatOctoMapWritesOfTheSameNodes) {
  const TemporaryFolder folder;
  OccupancyMap map({.resolution = kResolution});
  map.insert(colored_scan(1));
  map.insert(colored_scan(2));
  map.write(folder / "ours.ot");
  const auto tree = read_by_octomap(folder / "ours.ot");
  ASSERT_NE(tree, nullptr);
  // Inner nodes get values and colours anew from their children, as OctoMap makes them.
  tree->updateInnerOccupancy();
  ASSERT_TRUE(tree->write((folder / "theirs.ot").string()));
  EXPECT_TRUE(read_whole_file(folder / "ours.ot") == read_whole_file(folder / "theirs.ot"));
}

TEST(ColorOcTreeFile, GivesBackValuesAndMeans) {
  const TemporaryFolder folder;
  OccupancyMap map({.resolution = kResolution});
  map.insert(colored_scan(1));
  map.write(folder / "map.ot");
  const OccupancyMap back = OccupancyMap::read(folder / "map.ot");
  EXPECT_TRUE(is_same_map(back, map));
  EXPECT_TRUE(colors_of(back.colors()) == colors_of(map.colors()));
  back.write(folder / "again.ot");
  EXPECT_TRUE(read_whole_file(folder / "again.ot") == read_whole_file(folder / "map.ot"));
}

TEST(ColorOcTreeFile, PrunesWhatHasOneColorAndSplitsWhatHasTwo) {
  const TemporaryFolder folder;
  OccupancyMap map({.resolution = kResolution});
  map.bricks().find_or_add(0).fill(1);
  ColorBrick paint{.code = 0, .cells = CellMask::all(), .sums = {}};
  paint.sums.assign(kCellsPerBrick, {1, {9, 8, 7}});
  map.colors().add(std::span(&paint, 1));
  map.write(folder / "one.ot");
  const auto one = read_by_octomap(folder / "one.ot");
  ASSERT_NE(one, nullptr);
  EXPECT_EQ(one->getNumLeafNodes(), 1U);
  EXPECT_EQ(color_of(*one->begin_leafs()), (Color{9, 8, 7}));
  EXPECT_TRUE(colors_of(OccupancyMap::read(folder / "one.ot").colors()) == colors_of(map.colors()));
  ColorBrick dot{.code = 0, .cells = {}, .sums = {{1000, {0, 0, 0}}}};
  dot.cells.set(0);
  map.colors().add(std::span(&dot, 1));
  map.write(folder / "two.ot");
  const auto two = read_by_octomap(folder / "two.ot");
  ASSERT_NE(two, nullptr);
  EXPECT_EQ(two->getNumLeafNodes(), 1U + 3 * 7);
  EXPECT_TRUE(colors_of(OccupancyMap::read(folder / "two.ot").colors()) == colors_of(map.colors()));
}

TEST(ColorOcTreeFile, ReadsTreesThatOctoMapMade) {
  const TemporaryFolder folder;
  octomap::ColorOcTree tree(0.1);
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const auto part = [&] { return static_cast<float>(random.uniform() * 2 - 1); };
    const octomap::point3d x(part(), part(), part());
    tree.updateNode(x, random.below(3) > 0);
    const auto channel = [&] { return static_cast<std::uint8_t>(random.below(255)); };
    tree.integrateNodeColor(x.x(), x.y(), x.z(), channel(), channel(), channel());
  }
  tree.updateInnerOccupancy();
  ASSERT_TRUE(tree.write((folder / "theirs.ot").string()));
  const OccupancyMap map = OccupancyMap::read(folder / "theirs.ot");
  std::size_t leaves = 0;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf, ++leaves) {
    const octomap::point3d x = leaf.getCoordinate();
    const Eigen::Vector3d centre(x.x(), x.y(), x.z());
    ASSERT_EQ(map.log_odds(centre).value_or(9), leaf->getLogOdds());
    const auto cell = cell_of(centre, 0.1).value_or(CellKey{});
    ASSERT_EQ(map.colors().color(cell).value_or(kNoColor), color_of(*leaf));
  }
  EXPECT_GT(leaves, 1000U);
  map.write(folder / "ours.ot");
  EXPECT_TRUE(read_whole_file(folder / "ours.ot") == read_whole_file(folder / "theirs.ot"));
}

TEST(ColorOcTreeFile, FindsEveryTruncationAndSurvivesFlippedBytes) {
  const TemporaryFolder folder;
  OccupancyMap map({.resolution = 0.5});
  map.insert(colored_scan(1, 200));
  map.write(folder / "map.ot");
  const std::string whole = read_whole_file(folder / "map.ot");
  const auto read = [](const std::string& bytes) {
    return parse_octree(bytes, OccupancyOptions().model(), "map.ot");
  };
  for (std::size_t kept = 0; kept < whole.size(); kept += 5) {
    EXPECT_FALSE(error_of([&] { read(whole.substr(0, kept)); }).empty());
  }
  Random random(1);
  for (int trial = 0; trial < 500; ++trial) {
    std::string damaged = whole;
    damaged[random.below(damaged.size())] = static_cast<char>(random.below(256));
    try {
      read(damaged);
    } catch (const Error&) {
      // A sentence is as good as a map: a flipped colour is not visible.
    }
  }
}

}  // namespace
}  // namespace facula
