// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/grid_image.hpp>
#include <facula/map/navigation_grid.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

constexpr auto kFree = NavigationGrid::kFree;
constexpr auto kOccupied = NavigationGrid::kOccupied;
constexpr auto kUnknown = NavigationGrid::kUnknown;

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
  EXPECT_EQ(read_whole_file(folder / "floor.pgm"),
            "P5\n3 2\n255\n" + std::string("\xfe\0\xcd\0\0\xfe", 6));
  EXPECT_EQ(read_whole_file(folder / "floor.yaml"),
            "image: floor.pgm\nmode: trinary\nresolution: 0.03333333333333333\n"
            "origin: [-12.345678901234567, 1e-07, 0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST(NavigationGridFile, ReadsBackWhatItWrote) {
  const TemporaryFolder folder;
  for (const char* name : {"a.yaml", "map #1.yaml", "two words - \"#1\": x.yaml"}) {
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

TEST(NavigationGridFile, ReadsNamesInSingleQuotes) {
  const TemporaryFolder folder;
  folder.write("my map #1.pgm", "P5\n2 1\n255\n" + std::string("\xcd\xfe", 2));
  const auto yaml = folder.write("map.yaml",
                                 "image: 'my map #1.pgm'\nresolution: 0.05\norigin: [0, 0, 0]\n"
                                 "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
  EXPECT_EQ(read_navigation_grid(yaml).cells, (std::vector<std::uint8_t>{kUnknown, kFree}));
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

/// One row of every percentage and unknown.
NavigationGrid all_percentages() {
  NavigationGrid grid;
  grid.rows = 1;
  grid.cols = 102;
  grid.resolution = 0.05;
  grid.origin = {-1, 2};
  for (int percent = -1; percent <= 100; ++percent) {
    grid.occupancy.push_back(static_cast<std::int8_t>(percent));
    grid.cells.push_back(percent < 0 ? kUnknown : percent < 50 ? kFree : kOccupied);
  }
  return grid;
}

struct Pixel {
  int grey = 0;
  int alpha = 255;
};

/// What nav2's map server publishes for a pixel, from the pages of docs.nav2.org and the rules of
/// nav2_map_server: brightness 1 is free, thresholds are strict.
int nav2_publishes(const std::string& mode, Pixel pixel, double free_thresh) {
  const double occupancy = 1 - pixel.grey / 255.0;
  if (mode == "raw") return pixel.grey <= 100 ? pixel.grey : -1;
  if (mode == "scale" && pixel.alpha != 255) return -1;
  if (occupancy > 0.65) return 100;
  if (occupancy < free_thresh) return 0;
  if (mode == "trinary") return -1;
  return static_cast<int>(std::rint((occupancy - free_thresh) / (0.65 - free_thresh) * 100));
}

/// What ROS 1's map_server publishes: its scale mode asks the thresholds before transparency and
/// maps what lies between them to 1 to 99.
int ros1_publishes(const std::string& mode, Pixel pixel) {
  const double occupancy = (255 - pixel.grey) / 255.0;
  if (mode == "raw") return pixel.grey == 255 ? -1 : pixel.grey;
  if (occupancy > 0.65) return 100;
  if (occupancy < 0.196) return 0;
  if (mode == "trinary" || pixel.alpha < 1) return -1;
  return static_cast<int>(1 + 98 * (occupancy - 0.196) / (0.65 - 0.196));
}

/// The grid as written, read by the two rules above and by us.
struct Written {
  GridImage image;
  std::string yaml;
  NavigationGrid back;
};

Written written(const NavigationGrid& grid, const GridFileOptions& options) {
  const TemporaryFolder folder;
  write_navigation_grid(folder / "map.yaml", grid, options);
  const char* picture = options.mode == GridMode::kScale ? "map.png" : "map.pgm";
  return {read_grid_image(folder / picture),
          read_whole_file(folder / "map.yaml"),
          read_navigation_grid(folder / "map.yaml")};
}

TEST(GridModes, TrinaryComesBackAsTheThreeStatesInBothServers) {
  const NavigationGrid grid = all_percentages();
  const Written file = written(grid, {.mode = GridMode::kTrinary});
  EXPECT_NE(file.yaml.find("mode: trinary\n"), std::string::npos);
  EXPECT_NE(file.yaml.find("free_thresh: 0.196\n"), std::string::npos);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const int expected = grid.cells[i] == kUnknown ? -1 : grid.cells[i] == kFree ? 0 : 100;
    const Pixel pixel = {file.image.grey[i]};
    EXPECT_EQ(nav2_publishes("trinary", pixel, 0.196), expected);
    EXPECT_EQ(ros1_publishes("trinary", pixel), expected);
    EXPECT_EQ(file.back.occupancy[i], expected);
  }
  EXPECT_EQ(file.back.cells, grid.cells);
}

TEST(GridModes, TrinaryWithTheThresholdOfNav2WouldMakeUnknownFree) {
  // The reason why free_thresh is 0.196 in every trinary file.
  EXPECT_EQ(nav2_publishes("trinary", {kUnknown}, 0.25), 0);
  EXPECT_EQ(nav2_publishes("trinary", {kUnknown}, 0.196), -1);
}

TEST(GridModes, RawComesBackUnchangedInBothServers) {
  const NavigationGrid grid = all_percentages();
  const Written file = written(grid, {.mode = GridMode::kRaw});
  EXPECT_NE(file.yaml.find("mode: raw\n"), std::string::npos);
  EXPECT_EQ(file.image.grey.front(), 255);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Pixel pixel = {file.image.grey[i]};
    EXPECT_EQ(nav2_publishes("raw", pixel, 0.25), grid.occupancy[i]);
    EXPECT_EQ(ros1_publishes("raw", pixel), grid.occupancy[i]);
  }
  EXPECT_EQ(file.back.occupancy, grid.occupancy);
  EXPECT_EQ(file.back.cells, grid.cells);
}

TEST(GridModes, ScaleShowsProbabilitiesAsLightnessAndUnknownAsTransparent) {
  const NavigationGrid grid = all_percentages();
  for (const bool ros1 : {false, true}) {
    const Written file = written(grid, {.mode = GridMode::kScale, .ros1 = ros1});
    EXPECT_NE(file.yaml.find("image: map.png\nmode: scale\n"), std::string::npos);
    EXPECT_NE(file.yaml.find(ros1 ? "free_thresh: 0.196\n" : "free_thresh: 0.25\n"),
              std::string::npos);
    // By hand: 0 % is white, 100 % black, 40 % is 255 * 0.6 = 153.
    EXPECT_EQ(file.image.grey[1], 255);
    EXPECT_EQ(file.image.grey[101], 0);
    EXPECT_EQ(file.image.grey[41], 153);
    EXPECT_EQ(file.image.alpha[0], 0);
    EXPECT_EQ(file.image.alpha[1], 255);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const Pixel pixel = {file.image.grey[i], file.image.alpha[i]};
      const int nav2 = nav2_publishes("scale", pixel, ros1 ? 0.196 : 0.25);
      EXPECT_EQ(file.back.occupancy[i], nav2);
      // Never further than a step of 8 bits, stretched, from what was known.
      const double free = ros1 ? 19.6 : 25;
      const double stretched = (grid.occupancy[i] - free) / (65 - free) * 100;
      if (i > 0) {
        EXPECT_NEAR(nav2, std::min(100.0, std::max(0.0, stretched)), 1.1);
      }
      if (ros1) {
        EXPECT_NEAR(ros1_publishes("scale", pixel), nav2, i == 0 ? 0 : 2);
      }
    }
    EXPECT_EQ(file.back.occupancy[0], -1);
    EXPECT_EQ(file.back.cells[0], kUnknown);
  }
}

TEST(GridModes, NegatedFilesSayTheSame) {
  const NavigationGrid grid = all_percentages();
  for (const GridMode mode : {GridMode::kTrinary, GridMode::kScale}) {
    const Written plain = written(grid, {.mode = mode});
    const Written negated = written(grid, {.mode = mode, .negate = true});
    EXPECT_NE(negated.yaml.find("negate: 1\n"), std::string::npos);
    EXPECT_EQ(negated.back.occupancy, plain.back.occupancy);
    EXPECT_EQ(int{negated.image.grey[50]}, 255 - plain.image.grey[50]);
  }
  const TemporaryFolder folder;
  const auto negate_raw = [&] {
    write_navigation_grid(
        folder / "a.yaml", grid, {.mode = GridMode::kRaw, .ros1 = false, .negate = true});
  };
  EXPECT_NE(error_of(negate_raw).find("raw"), std::string::npos);
}

TEST(GridModes, AreReadFromFilesThatOthersWrote) {
  const TemporaryFolder folder;
  folder.write("map.pgm", "P5\n4 1\n255\n" + std::string("\0\x32\x65\xff", 4));
  const std::string rest =
      "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.65\n"
      "free_thresh: 0.25\n";
  const auto read = [&](const std::string& lines) {
    return read_navigation_grid(folder.write("map.yaml", lines + rest)).occupancy;
  };
  using Percent = std::vector<std::int8_t>;
  EXPECT_EQ(read("mode: raw\nnegate: 0\n"), (Percent{0, 50, -1, -1}));
  // 0x32 = 50: occupancy 0.804; 0x65 = 101: 0.604, (0.604 - 0.25) / 0.4 = 88.5 %.
  EXPECT_EQ(read("mode: scale\nnegate: 0\n"), (Percent{100, 100, 88, 0}));
  EXPECT_EQ(read("mode: \"scale\"\nnegate: true\n"), (Percent{0, 0, 37, 100}));
  EXPECT_EQ(read("negate: no\n"), (Percent{100, 100, -1, 0}));
  EXPECT_NE(error_of([&] { read("mode: binary\nnegate: 0\n"); }).find("trinary"),
            std::string::npos);
}

TEST(GridModes, NeedProbabilitiesWhereTheyWriteThem) {
  const TemporaryFolder folder;
  for (const GridMode mode : {GridMode::kScale, GridMode::kRaw}) {
    const std::string sentence =
        error_of([&] { write_navigation_grid(folder / "a.yaml", sample_grid(), {.mode = mode}); });
    EXPECT_NE(sentence.find("probabilities"), std::string::npos) << sentence;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(GridModes, SayThatAPictureIsTorn) {
  const TemporaryFolder folder;
  write_navigation_grid(folder / "map.yaml", all_percentages(), {.mode = GridMode::kScale});
  const std::string whole = read_whole_file(folder / "map.png");
  for (const std::size_t length : {std::size_t{0}, std::size_t{7}, std::size_t{30}}) {
    folder.write("map.png", whole.substr(0, length));
    const std::string sentence = error_of([&] { read_navigation_grid(folder / "map.yaml"); });
    EXPECT_NE(sentence.find("map.png"), std::string::npos) << sentence;
  }
}

}  // namespace
}  // namespace facula
