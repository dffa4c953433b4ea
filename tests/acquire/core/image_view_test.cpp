// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/image_view.hpp>

#include <gtest/gtest.h>

namespace facula {
namespace {

TEST(ImageView, StepsOverThePaddingOfARow) {
  const std::vector<std::uint16_t> memory{1, 2, 3, 90, 91, 4, 5, 6, 92, 93};
  const ImageView16 view{memory.data(), 2, 3, 1, 5};
  EXPECT_EQ(view.row(0)[2], 3);
  EXPECT_EQ(view.row(1)[0], 4);
}

TEST(ImageView, LooksAtTheMiddleOfALargerImage) {
  Image8 image(4, 5);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = static_cast<std::uint8_t>(i);
  }
  const ImageView8 window{image.row(1) + 2, 2, 2, 1, image.stride()};
  EXPECT_EQ(window.row(0)[0], 7);
  EXPECT_EQ(window.row(1)[1], 13);
}

TEST(ImageView, CountsColourChannelsInItsStride) {
  Image8 image(2, 3, 3);
  EXPECT_EQ(image.stride(), 9);
  image.row(1)[3 * 2 + 1] = 200;  // green of the last pixel
  EXPECT_EQ(image.view().row(1)[7], 200);
  EXPECT_EQ(image.pixels.size(), 18U);
}

TEST(ImageView, IsEmptyWithoutPixels) {
  EXPECT_TRUE(ImageView8().empty());
  EXPECT_TRUE(Image8().empty());
  EXPECT_FALSE(Image8(1, 1).view().empty());
}

}  // namespace
}  // namespace facula
