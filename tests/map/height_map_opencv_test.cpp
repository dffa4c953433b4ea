// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/height_map.hpp>
#include <facula/tests/map/drawn_map.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace facula {
namespace {

constexpr double kCell = 0.1;

/// Free space over 6 x 4 cells, floor at 0; a box of 0.3 m at x = 1, a lamp at 2 m over x = 3, no
/// floor at x = 5.
OccupancyMap scene() {
  DrawnMap drawn(kCell);
  drawn.free({{0, 0, 0}, {6, 4, 30}});
  drawn.occupy({{0, 0, -1}, {5, 4, 0}});
  drawn.occupy({{1, 2, 0}, {2, 3, 3}});
  drawn.occupy({{3, 1, 19}, {4, 2, 20}});
  return drawn.map();
}

float at(const HeightMap& heights, int x, int y) {
  const auto row = static_cast<std::size_t>(heights.rows - 1 - y);
  return heights.top[row * static_cast<std::size_t>(heights.cols) + static_cast<std::size_t>(x)];
}

TEST(HeightMap, StandsOnTheHighestFaceOfEveryColumn) {
  const HeightMap heights = height_map(scene());
  ASSERT_EQ(heights.cols, 6);
  ASSERT_EQ(heights.rows, 4);
  EXPECT_NEAR(heights.origin.norm(), 0, 1e-12);
  EXPECT_EQ(heights.resolution, kCell);
  EXPECT_NEAR(at(heights, 0, 0), 0.0, 1e-6);
  EXPECT_NEAR(at(heights, 1, 2), 0.3, 1e-6);
  EXPECT_NEAR(at(heights, 1, 1), 0.0, 1e-6);
  EXPECT_NEAR(at(heights, 3, 1), 2.0, 1e-6);
  EXPECT_TRUE(std::isnan(at(heights, 5, 3)));
}

TEST(HeightMap, LeavesOutWhatReachesAboveTheLimit) {
  EXPECT_NEAR(at(height_map(scene(), {.max_height = 2.0}), 3, 1), 2.0, 1e-6);
  EXPECT_NEAR(at(height_map(scene(), {.max_height = 1.99}), 3, 1), 0.0, 1e-6);
  EXPECT_NEAR(at(height_map(scene(), {.max_height = 0.25}), 1, 2), 0.2, 1e-6);
}

TEST(HeightMap, SaysThatNothingIsKnownBelowTheLimit) {
  EXPECT_NE(error_of([] { height_map(OccupancyMap{}); }).find("knows nothing"), std::string::npos);
  EXPECT_NE(error_of([] { height_map(scene(), {.max_height = -5}); }).find("-5 m"),
            std::string::npos);
  EXPECT_NE(error_of([] { height_map(scene(), {.max_height = std::nan("")}); }).find("max_height"),
            std::string::npos);
}

TEST(HeightMapFile, IsATiffOfFloatsThatOthersRead) {
  const TemporaryFolder folder;
  const HeightMap heights = height_map(scene());
  write_height_map(folder / "height map.tif", heights);
  const cv::Mat picture = cv::imread((folder / "height map.tif").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(picture.type(), CV_32FC1);
  ASSERT_EQ(picture.rows, heights.rows);
  ASSERT_EQ(picture.cols, heights.cols);
  for (int row = 0; row < picture.rows; ++row) {
    for (int col = 0; col < picture.cols; ++col) {
      const float expected = at(heights, col, heights.rows - 1 - row);
      const auto found = picture.at<float>(row, col);
      EXPECT_TRUE(found == expected || (std::isnan(found) && std::isnan(expected)));
    }
  }
  EXPECT_EQ(read_whole_file(folder / "height map.tif.yaml"),
            "image: \"height map.tif\"\nresolution: 0.1\norigin: [0, 0, 0]\nunit: m\n"
            "no_height: nan\n");
}

TEST(HeightMapFile, WritesBothFilesOrNone) {
  const TemporaryFolder folder;
  const HeightMap heights = height_map(scene());
  EXPECT_NE(error_of([&] { write_height_map(folder / "a.png", heights); }).find(".tif"),
            std::string::npos);
  HeightMap uneven = heights;
  uneven.top.pop_back();
  EXPECT_NE(error_of([&] { write_height_map(folder / "a.tif", uneven); }).find("4 x 6"),
            std::string::npos);
  EXPECT_NE(
      error_of([&] { write_height_map(folder / "none" / "a.tif", heights); }).find("cannot write"),
      std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace facula
