// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

namespace facula {
namespace {

/// Frame i is grey level 5 i + 20 throughout.
void write_video(const std::filesystem::path& file, int frames) {
  cv::VideoWriter writer(
      file.string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, cv::Size(64, 48), true);
  for (int i = 0; i < frames; ++i) {
    writer.write(cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(5 * i + 20)));
  }
}

TEST(Video, GivesFramesInAnyOrder) {
  const TemporaryFolder folder;
  write_video(folder / "run.avi", 40);
  const auto video = open_frames({folder / "run.avi"});
  ASSERT_EQ(video->size(), 40U);
  for (const std::size_t i : {0U, 39U, 38U, 1U, 20U, 2U}) {
    EXPECT_NEAR(video->read(i).row(20)[30], 5.0 * static_cast<double>(i) + 20, 3) << i;
  }
}

TEST(Video, BringsABackgroundForEveryFrameOrOneForAll) {
  const TemporaryFolder folder;
  write_video(folder / "on.avi", 4);
  write_video(folder / "off.avi", 4);
  write_video(folder / "one.avi", 1);
  write_video(folder / "two.avi", 2);
  Capture capture;
  capture.frames = {folder / "on.avi"};
  capture.background = {folder / "off.avi"};
  EXPECT_NEAR(CaptureFrames(capture).dark(3).row(20)[30], 35, 3);
  capture.background = {folder / "one.avi"};
  EXPECT_NEAR(CaptureFrames(capture).dark(3).row(20)[30], 20, 3);
  capture.background = {folder / "two.avi"};
  EXPECT_NE(error_of([&] { CaptureFrames{capture}; }).find("got 2 for 4 frames"),
            std::string::npos);
}

TEST(Image, ComesIn8BitsWithoutAlpha) {
  const TemporaryFolder folder;
  cv::imwrite((folder / "deep.png").string(), cv::Mat(4, 5, CV_16UC1, cv::Scalar(0x1234)));
  const Image8 deep = read_image(folder / "deep.png");
  EXPECT_EQ(deep.channels, 1);
  EXPECT_EQ(deep.row(3)[4], 0x12);
  cv::imwrite((folder / "alpha.png").string(), cv::Mat(4, 5, CV_8UC4, cv::Scalar(10, 20, 30, 40)));
  const Image8 alpha = read_image(folder / "alpha.png");
  ASSERT_EQ(alpha.channels, 3);
  EXPECT_EQ(alpha.row(3)[12], 10);
  EXPECT_EQ(alpha.row(3)[14], 30);
}

TEST(Video, SaysWhenItCannotBeDecoded) {
  const TemporaryFolder folder;
  const auto file = folder.write("run.avi", "no video at all");
  EXPECT_NE(error_of([&] { open_frames({file}); }).find("run.avi"), std::string::npos);
}

}  // namespace
}  // namespace facula
