// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/apps/report/png.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace facula {
namespace {

Image8 random_picture(int rows, int cols, int channels) {
  Image8 picture(rows, cols, channels);
  Random random(7);
  for (std::uint8_t& value : picture.pixels) value = static_cast<std::uint8_t>(random.below(256));
  return picture;
}

TEST(Png, DecodesToTheSamePixels) {
  for (const int channels : {1, 3}) {
    const Image8 picture = random_picture(37, 53, channels);
    const std::string bytes = encode_png(picture);
    EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
    const std::vector<std::uint8_t> buffer(bytes.begin(), bytes.end());
    const cv::Mat decoded = cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
    ASSERT_EQ(decoded.rows, picture.rows);
    ASSERT_EQ(decoded.cols, picture.cols);
    ASSERT_EQ(decoded.channels(), channels);
    EXPECT_TRUE(std::equal(picture.pixels.begin(), picture.pixels.end(), decoded.datastart));
  }
}

TEST(Png, IsWrittenToAFile) {
  const TemporaryFolder folder;
  const Image8 picture = random_picture(5, 4, 3);
  write_png(folder / "a.png", picture);
  const cv::Mat decoded = cv::imread((folder / "a.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(decoded.rows, 5);
  EXPECT_TRUE(std::equal(picture.pixels.begin(), picture.pixels.end(), decoded.datastart));
}

TEST(Png, RefusesAnEmptyPicture) {
  EXPECT_NE(error_of([] { encode_png({}); }).find("0 x 0"), std::string::npos);
}

}  // namespace
}  // namespace facula
