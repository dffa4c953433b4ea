// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/navigation_grid.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <fstream>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr double kCell = 0.1;
constexpr auto kFree = NavigationGrid::kFree;
constexpr auto kOccupied = NavigationGrid::kOccupied;
constexpr auto kUnknown = NavigationGrid::kUnknown;

Eigen::Vector3f centre(int x, int y, int z) {
  return ((Eigen::Vector3d(x, y, z).array() + 0.5) * kCell).cast<float>();
}

void add_ray(PointCloud& cloud, const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  cloud.sensor_origin.push_back(from);
  cloud.points.push_back(to);
}

/// Seen from cell (2, 1): a post 4 cells along +x and one 2 cells along +y, at cell height 5; a
/// table top at height 30 (above the band) over cell (0, 1), with the floor below it free.
OccupancyMap corner_scene() {
  PointCloud cloud;
  add_ray(cloud, centre(2, 1, 5), centre(6, 1, 5));
  add_ray(cloud, centre(2, 1, 5), centre(2, 3, 5));
  add_ray(cloud, centre(0, 1, 5), centre(0, 1, 30));
  OccupancyMap map({.resolution = kCell});
  map.insert(cloud);
  return map;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(NavigationGrid, LooksDownOnTheSceneWithYUpwards) {
  const NavigationGrid grid = navigation_grid(corner_scene());
  ASSERT_EQ(grid.cols, 7);
  ASSERT_EQ(grid.rows, 3);
  EXPECT_NEAR(grid.origin.x(), 0.0, 1e-9);
  EXPECT_NEAR(grid.origin.y(), 0.1, 1e-9);
  const std::vector<std::uint8_t> expected = {
      kUnknown, kUnknown, kOccupied, kUnknown, kUnknown, kUnknown, kUnknown,   // y = 3
      kUnknown, kUnknown, kFree,     kUnknown, kUnknown, kUnknown, kUnknown,   // y = 2
      kFree,    kUnknown, kFree,     kFree,    kFree,    kFree,    kOccupied,  // y = 1
  };
  EXPECT_EQ(grid.cells, expected);
}

TEST(NavigationGrid, TakesOnlyTheHeightsItIsAskedFor) {
  const OccupancyMap map = corner_scene();
  const NavigationGrid high = navigation_grid(map, {.min_height = 2.9, .max_height = 3.5});
  ASSERT_EQ(high.cells.size(), 1U + 0U);
  EXPECT_EQ(high.cells[0], kOccupied);
  // A band that only shares a face with a cell does not contain it.
  const NavigationGrid below = navigation_grid(map, {.min_height = 0.6, .max_height = 3.0});
  ASSERT_EQ(below.cells.size(), 1U);
  EXPECT_EQ(below.cells[0], kFree);
}

TEST(NavigationGrid, PaintsPrunedLeavesInFull) {
  PointCloud cloud;
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 4; ++y) {
      add_ray(cloud, centre(x, y, -1), centre(x, y, 4));
    }
  }
  OccupancyMap map({.resolution = kCell});
  map.insert(cloud);
  double largest = 0;
  map.for_each_leaf(
      [&](const Eigen::Vector3d&, CellState, double edge) { largest = std::max(largest, edge); });
  ASSERT_GT(largest, 3.9 * kCell) << "nothing was pruned: the test tests nothing";
  const NavigationGrid grid = navigation_grid(map, {.min_height = 0.05, .max_height = 0.35});
  EXPECT_EQ(grid.cells, std::vector<std::uint8_t>(16, kFree));
}

TEST(NavigationGrid, SaysThatNothingWasSeenBetweenTheHeights) {
  const OccupancyMap map = corner_scene();
  const auto grid_at = [&](double low, double high) {
    return error_of([&] { navigation_grid(map, {.min_height = low, .max_height = high}); });
  };
  EXPECT_NE(grid_at(50, 51).find("no known cell"), std::string::npos);
  EXPECT_NE(grid_at(1, 1).find("max_height"), std::string::npos);
  EXPECT_NE(error_of([] { navigation_grid(OccupancyMap{}); }).find("no known cell"),
            std::string::npos);
}

NavigationGrid sample_grid() {
  NavigationGrid grid;
  grid.rows = 2;
  grid.cols = 3;
  grid.resolution = 1.0 / 30;
  grid.origin = {-12.345678901234567, 1e-7};
  grid.cells = {kFree, kOccupied, kUnknown, kOccupied, kOccupied, kFree};
  return grid;
}

TEST(NavigationGridFile, WritesThePixelsAndKeysThatMapServersRead) {
  const TemporaryFolder folder;
  write_navigation_grid(folder / "floor.yaml", sample_grid());
  EXPECT_EQ(text_of(folder / "floor.pgm"), "P5\n3 2\n255\n" + std::string("\xfe\0\xcd\0\0\xfe", 6));
  EXPECT_EQ(text_of(folder / "floor.yaml"),
            "image: floor.pgm\nmode: trinary\nresolution: 0.03333333333333333\n"
            "origin: [-12.345678901234567, 1e-07, 0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST(NavigationGridFile, ReadsBackWhatItWrote) {
  const TemporaryFolder folder;
  for (const char* name : {"a.yaml", "two words - \"#1\": x.yaml"}) {
    write_navigation_grid(folder / name, sample_grid());
    const NavigationGrid back = read_navigation_grid(folder / name);
    EXPECT_EQ(back.rows, 2);
    EXPECT_EQ(back.cols, 3);
    EXPECT_EQ(back.resolution, sample_grid().resolution);
    EXPECT_EQ(back.origin, sample_grid().origin);
    EXPECT_EQ(back.cells, sample_grid().cells);
  }
}

TEST(NavigationGridFile, ReadsWhatTheRosMapSaverWrites) {
  const TemporaryFolder folder;
  folder.write("map.pgm", "P5\n# CREATOR: map_saver\n2 1\n255\n" + std::string("\xcd\xfe", 2));
  const auto yaml = folder.write("map.yaml",
                                 "image: map.pgm\nresolution: 0.050000  # m\n"
                                 "origin: [-10.000000, -10.000000, 0.000000]\nnegate: 0\n"
                                 "occupied_thresh: 0.65\nfree_thresh: 0.196\n\n");
  const NavigationGrid grid = read_navigation_grid(yaml);
  EXPECT_EQ(grid.cells, (std::vector<std::uint8_t>{kUnknown, kFree}));
  EXPECT_EQ(grid.resolution, 0.05);
  EXPECT_EQ(grid.origin, Eigen::Vector2d(-10, -10));
}

TEST(NavigationGridFile, SaysWhatIsWrongWithAFile) {
  const TemporaryFolder folder;
  folder.write("ok.pgm", "P5\n2 1\n255\n" + std::string("\0\0", 2));
  folder.write("torn.pgm", "P5\n2 2\n255\n" + std::string("\0\0", 2));
  folder.write("huge.pgm", "P5\n2000000000 2000000000\n255\n..");
  folder.write("text.pgm", "P2\n2 1\n255\n0 0\n");
  folder.write("deep.pgm", "P5\n2 1\n65535\n....");
  folder.write("short.pgm", "P5\n2");
  const std::string rest =
      "\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: "
      "0.196\n";
  const std::map<std::string, std::string> cases = {
      {"image: torn.pgm" + rest, "torn"},
      {"image: huge.pgm" + rest, "torn"},
      {"image: text.pgm" + rest, "P5"},
      {"image: deep.pgm" + rest, "65535"},
      {"image: short.pgm" + rest, "P5"},
      {"image: none.pgm" + rest, "none.pgm"},
      {rest, "image"},
      {"image: ok.pgm\n", "resolution"},
      {"image: ok.pgm\nresolution: wide\n", "resolution"},
      {"image: ok.pgm\nresolution: 0\n", "resolution"},
      {"image: ok.pgm\nresolution: 1\norigin: [0, 0]\n", "origin"},
      {"image: ok.pgm\nresolution: 1\norigin: [0, 0, 1]\n", "turned"},
      {"", "resolution"}};
  for (const auto& [text, expected] : cases) {
    const auto path = folder.write("map.yaml", text);
    const std::string sentence = error_of([&] { read_navigation_grid(path); });
    EXPECT_NE(sentence.find(expected), std::string::npos) << sentence;
  }
  EXPECT_NE(error_of([&] { read_navigation_grid(folder / "x.yaml"); }).find("no such file"),
            std::string::npos);
}

TEST(NavigationGridFile, WritesBothFilesOrNone) {
  const TemporaryFolder folder;
  const auto write_to = [&](const std::filesystem::path& path) {
    return error_of([&] { write_navigation_grid(path, sample_grid()); });
  };
  EXPECT_NE(write_to(folder / "none" / "map.yaml").find("cannot write"), std::string::npos);
  EXPECT_NE(write_to(folder / "map.png").find(".yaml"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  std::filesystem::create_directory(folder / "map.yaml");  // the second file cannot be written
  EXPECT_NE(write_to(folder / "map.yaml").find("cannot write"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "map.pgm"));
  NavigationGrid uneven = sample_grid();
  uneven.cells.pop_back();
  EXPECT_NE(error_of([&] { write_navigation_grid(folder / "a.yaml", uneven); }).find("2 x 3"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
