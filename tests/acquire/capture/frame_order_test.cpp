// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/tests/acquire/capture/small_rig.hpp>
#include <facula/tests/acquire/stripe/line_image.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A capture whose frames are named by what is in them.
class FrameOrder : public testing::Test {
 protected:
  FrameOrder() { write_small_rig(folder_); }

  /// Writes frame number i: a line of an amplitude (0: none) over a level.
  void write(int i, double amplitude, double level = 20) {
    LineImage line;
    line.rows = 48;
    line.cols = 64;
    line.sigma = 1.5;
    line.noise = 1;
    line.amplitude = amplitude;
    line.background = level;
    line.position = [](int r) { return 44.0 + 0.02 * r; };
    line.seed = static_cast<std::uint64_t>(i) + 1;
    write_image(folder_ / ("f" + std::to_string(100 + i) + ".png"), draw(line).view());
  }

  Capture capture(const std::string& frames, const std::string& volume = "") {
    folder_.write("capture.toml",
                  "rig = \"rig.toml\"\n[frames]\non = \"f*.png\"\n" + frames +
                      "\n[positions]\nstep_deg = 2\n[stripe]\nsigma_px = 1.5\n" + volume);
    return read_capture(folder_.path());
  }

  std::string complaint(const std::string& frames) {
    return error_of([&] { extract_scan(capture(frames)); });
  }

  TemporaryFolder folder_;
};

double mean_of_image(const Image8& image) {
  double sum = 0;
  for (const std::uint8_t value : image.pixels) sum += value;
  return sum / static_cast<double>(image.pixels.size());
}

TEST_F(FrameOrder, OffOnOffTakesTheMeanOfTheDarkFrames) {
  for (int p = 0; p < 4; ++p) {
    write(3 * p, 0, 20);
    write(3 * p + 1, 120, 30);
    write(3 * p + 2, 0, 40);
  }
  const Capture taken = capture("alternating = \"off-on-off\"");
  ASSERT_EQ(taken.positions.size(), 4U);
  const CapturedFrame frame = CaptureFrames(taken).read(1);
  EXPECT_EQ(frame.lit.pixels, read_image(folder_ / "f104.png").pixels);
  EXPECT_NEAR(mean_of_image(frame.dark), 30, 0.2);
  EXPECT_EQ(frame.moving.rows, 48);
  EXPECT_EQ(extract_scan(taken).scan.valid_count(), 4U * 48U);
}

TEST_F(FrameOrder, OnOffOnTakesTheMeanOfTheLitFrames) {
  for (int p = 0; p < 4; ++p) {
    write(3 * p, 100);
    write(3 * p + 1, 0);
    write(3 * p + 2, 100);
  }
  const Capture taken = capture("alternating = \"on-off-on\"");
  const CaptureFrames frames(taken);
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames.dark(2).pixels, read_image(folder_ / "f107.png").pixels);
  EXPECT_GT(mean_of_image(frames.lit(0)), mean_of_image(frames.dark(0)) + 3);
  EXPECT_EQ(extract_scan(taken).scan.valid_count(), 4U * 48U);
}

TEST_F(FrameOrder, FlickerIsMatchedBeforeTheBackgroundIsTakenOff) {
  for (int p = 0; p < 4; ++p) {
    write(2 * p, 100, 60);
    write(2 * p + 1, 0, 80);
  }
  const CaptureFrames ignored(capture("alternating = \"on-first\""));
  const CaptureFrames matched(capture("alternating = \"on-first\"\nflicker = \"frame\""));
  EXPECT_NEAR(mean_of_image(ignored.dark(0)), 80, 0.3);
  EXPECT_NEAR(mean_of_image(matched.dark(0)), 60, 0.6);
}

TEST_F(FrameOrder, ExposuresOfOnePositionMakeOneColumn) {
  for (int p = 0; p < 3; ++p) {
    write(2 * p, 15);
    write(2 * p + 1, 120);
  }
  const Capture taken = capture("exposures_ms = [2, 16]");
  ASSERT_EQ(taken.positions.size(), 3U);
  const ExtractResult result = extract_scan(taken);
  EXPECT_EQ(result.scan.valid_count(), 3U * 48U);
  Capture dim = taken;
  dim.exposures.clear();
  dim.frames = {taken.frames[0], taken.frames[2], taken.frames[4]};
  const ExtractResult alone = extract_scan(dim);
  EXPECT_LT(result.median_pixel_sigma, 0.5 * alone.median_pixel_sigma);
}

TEST_F(FrameOrder, ALogOfABracketGivesTheSameScan) {
  for (int i = 0; i < 6; ++i) write(i, i % 2 == 0 ? 15 : 120);
  const Capture taken = capture("exposures_ms = [2, 16]");
  ExtractOptions options;
  options.log = folder_ / "scan.log";
  const ExtractResult logged = extract_scan(taken, options);
  const ExtractResult direct = extract_scan(taken);
  EXPECT_EQ(logged.scan.valid_count(), 3U * 48U);
  EXPECT_EQ(logged.scan.range, direct.scan.range);
}

TEST_F(FrameOrder, TheWorkVolumeGatesTheColumns) {
  for (int i = 0; i < 4; ++i) write(i, 100);
  // The line stands at x = 44 to 45, that is z = 60 * 50 / 13 = 230 mm.
  const Capture inside = capture("", "[volume]\nmin_depth_mm = 200\nmax_depth_mm = 260\n");
  EXPECT_EQ(extract_scan(inside).stripes_seen, 4U * 48U);
  const Capture outside = capture("", "[volume]\nmin_depth_mm = 2000\nmax_depth_mm = 4000\n");
  EXPECT_EQ(extract_scan(outside).stripes_seen, 0U);
}

TEST_F(FrameOrder, SaysWhatIsWrongWithTheOrder) {
  for (int i = 0; i < 4; ++i) write(i, 100);
  EXPECT_NE(complaint("alternating = \"sometimes\"").find("off-on-off"), std::string::npos);
  EXPECT_NE(complaint("flicker = \"frame\"").find("no background"), std::string::npos);
  EXPECT_NE(complaint("alternating = \"on-first\"\nflicker = \"much\"").find("rows"),
            std::string::npos);
  EXPECT_NE(complaint("exposures_ms = [1, -2]").find("above 0"), std::string::npos);
  EXPECT_NE(complaint("exposures_ms = []").find("1 to 16"), std::string::npos);
  EXPECT_NE(complaint("exposures_ms = [1, 2, 3]").find("no multiple"), std::string::npos);
  std::filesystem::copy_file(folder_ / "f100.png", folder_ / "dark.png");
  EXPECT_NE(complaint("exposures_ms = [1, 2]\noff = \"dark.png\"").find("of an exposure (2)"),
            std::string::npos);
  for (int i = 101; i < 104; ++i) {
    std::filesystem::remove(folder_ / ("f" + std::to_string(i) + ".png"));
  }
  EXPECT_NE(complaint("alternating = \"on-off-on\"").find("3 frames per position"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
