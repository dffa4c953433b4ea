// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/axis_positions.hpp>
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/capture/frame_list.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/tests/acquire/capture/small_rig.hpp>
#include <facula/tests/acquire/stripe/line_image.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

/// A capture of small frames with an upright line in each, in a folder of its own.
class CaptureFile : public testing::Test {
 protected:
  CaptureFile() {
    write_small_rig(folder_);
    write_capture("on = \"lit*.png\"", "step_deg = 2");
    for (int i = 1; i <= 12; ++i) write_frame("lit" + std::to_string(i) + ".png", i);
  }

  void write_frame(const std::string& name, int shift) const {
    LineImage line;
    line.rows = 48;
    line.cols = 64;
    line.sigma = 1.5;
    line.position = [shift](int) { return 40.0 + shift; };
    write_image(folder_ / name, draw(line).view());
  }

  void write_capture(const std::string& frames, const std::string& positions) const {
    folder_.write("capture.toml",
                  "rig = \"rig.toml\"\n[frames]\n" + frames + "\n[positions]\n" + positions +
                      "\n[stripe]\nsigma_px = 1.5\n");
  }

  std::string complaint() const {
    return error_of([&] { extract_scan(read_capture(folder_.path())); });
  }

  bool complains_of(const std::string& words) const {
    const std::string said = complaint();
    EXPECT_NE(said.find(words), std::string::npos) << said;
    return said.find(words) != std::string::npos;
  }

  TemporaryFolder folder_;
};

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST_F(CaptureFile, CountsFramesAsPeopleDo) {
  const Capture capture = read_capture(folder_.path());
  ASSERT_EQ(capture.frames.size(), 12U);
  EXPECT_EQ(capture.frames[1].filename(), "lit2.png");
  EXPECT_EQ(capture.frames[9].filename(), "lit10.png");
  EXPECT_NEAR(capture.positions[11], 22 * std::numbers::pi / 180, 1e-12);
}

TEST_F(CaptureFile, ExtractsTheRangeOfEveryFrame) {
  const ExtractResult result = extract_scan(read_capture(folder_.path()));
  EXPECT_EQ(result.scan.valid_count(), 12U * 48U);
  for (int col = 0; col < 12; ++col) {
    // z = f s / x (source A, 1) and the baseline beside it, about the pan axis at the camera
    // centre.
    const double x = 40 + (col + 1) - 31.5;
    const double z = 60 * 0.05 / x;
    const double y = (20 - 23.5) / 60 * z;
    const float range = result.scan.range[result.scan.index(20, col)];
    EXPECT_NEAR(static_cast<double>(range), std::sqrt(0.05 * 0.05 + y * y + z * z), 0.004 * z);
  }
}

TEST_F(CaptureFile, HandsHowTheHeadStandsToTheScan) {
  EXPECT_EQ(extract_scan(read_capture(folder_.path())).scan.stand, ScanStand::kFree);
  const std::string text = read_text(folder_ / "capture.toml");
  folder_.write("capture.toml", "stand = \"upright\"\n" + text);
  EXPECT_EQ(extract_scan(read_capture(folder_.path())).scan.stand, ScanStand::kUpright);
  folder_.write("capture.toml", "stand = \"askew\"\n" + text);
  EXPECT_TRUE(complains_of("'stand': expected free, upright or table, got 'askew'"));
}

TEST_F(CaptureFile, GivesTheSameScanForEveryNumberOfThreads) {
  const Capture capture = read_capture(folder_.path());
  const PolarScan one = extract_scan(capture, {.num_threads = 1}).scan;
  const PolarScan many = extract_scan(capture, {.num_threads = 5}).scan;
  EXPECT_EQ(one.range, many.range);
  EXPECT_EQ(one.sigma, many.sigma);
}

TEST_F(CaptureFile, FindsFramesThatLieElsewhere) {
  const TemporaryFolder elsewhere;
  for (int i = 1; i <= 12; ++i) {
    const std::string name = "lit" + std::to_string(i) + ".png";
    std::filesystem::rename(folder_ / name, elsewhere / name);
  }
  EXPECT_TRUE(complains_of("--frames"));
  EXPECT_EQ(read_capture(folder_.path(), elsewhere.path()).frames.size(), 12U);
}

TEST_F(CaptureFile, PairsAlternatingFrames) {
  write_capture("on = \"lit*.png\"\nalternating = \"off-first\"", "step_deg = 2");
  const Capture capture = read_capture(folder_.path());
  EXPECT_EQ(capture.positions.size(), 6U);
  const CaptureFrames frames(capture);
  EXPECT_EQ(frames.lit(0).pixels, read_image(folder_ / "lit2.png").pixels);
  EXPECT_EQ(frames.dark(2).pixels, read_image(folder_ / "lit5.png").pixels);
}

TEST_F(CaptureFile, LeavesOutALastFrameWithoutItsPartner) {
  write_frame("lit13.png", 13);
  write_capture("on = \"lit*.png\"\nalternating = \"on-first\"", "step_deg = 2");
  const CaptureFrames frames(read_capture(folder_.path()));
  ASSERT_EQ(frames.size(), 6U);
  EXPECT_EQ(frames.lit(5).pixels, read_image(folder_ / "lit11.png").pixels);
  EXPECT_EQ(frames.dark(5).pixels, read_image(folder_ / "lit12.png").pixels);
}

TEST_F(CaptureFile, TakesOneBackgroundForAllFramesOrOneEach) {
  write_frame("dark.png", 1);
  write_capture("on = \"lit*.png\"\noff = \"dark.png\"", "step_deg = 2");
  const Image8 dark = read_image(folder_ / "dark.png");
  EXPECT_EQ(CaptureFrames(read_capture(folder_.path())).dark(11).pixels, dark.pixels);
  write_capture("on = \"lit1.png\"\noff = \"dark.png\"", "step_deg = 2");
  EXPECT_EQ(CaptureFrames(read_capture(folder_.path())).dark(0).pixels, dark.pixels);
  write_capture("on = \"lit*.png\"\noff = \"lit1?.png\"", "step_deg = 2");
  EXPECT_TRUE(complains_of("one background for all frames or one each, got 3 for 12"));
}

TEST_F(CaptureFile, TakesTheLaserThatTheCaptureNames) {
  const std::string one_laser = read_text(folder_ / "rig.toml");
  folder_.write("rig.toml",
                one_laser + "[[laser]]\nname = \"left\"\nnormal = [1, 0, 0]\ndistance_mm = -80\n");
  EXPECT_TRUE(complains_of("'laser': missing; the rig has 2 lasers"));
  const std::string capture = read_text(folder_ / "capture.toml");
  folder_.write("capture.toml", "laser = \"left\"\n" + capture);
  EXPECT_EQ(read_capture(folder_.path()).laser, 1U);
  folder_.write("capture.toml", "laser = \"right\"\n" + capture);
  EXPECT_TRUE(complains_of("the rig has no laser 'right'"));
  folder_.write("rig.toml", one_laser + "[[laser]]\nnormal = [1, 0, 0]\ndistance_mm = -80\n");
  EXPECT_TRUE(complains_of("two [[laser]] are called 'laser'"));
}

TEST_F(CaptureFile, RefusesValuesOutOfRange) {
  write_capture("on = \"lit*.png\"\ninterval_s = -1", "step_deg = 2");
  EXPECT_TRUE(complains_of("'frames.interval_s': expected a time of 0 or more"));
  write_capture("on = \"lit*.png\"", "step_deg = 2");
  const std::string good = read_text(folder_ / "capture.toml");
  for (const char* region : {"[0.5, 0, 0, 0]", "[0, 0, 1e300, 0]"}) {
    folder_.write("capture.toml", good + "region_px = " + region + "\n");
    EXPECT_TRUE(complains_of("'stripe.region_px': expected whole pixels"));
  }
  folder_.write("capture.toml", good + "min_run = -9223372036854775808\n");
  EXPECT_TRUE(complains_of("'stripe.min_run': expected a whole number"));
  folder_.write("capture.toml", good + "[volume]\nmin_z_mm = 10\nmax_z_mm = 5\n");
  EXPECT_TRUE(complains_of("min_z_mm below max_z_mm, got 10 and 5 mm"));
}

TEST_F(CaptureFile, AsksForBothHalvesOfAZeroLine) {
  write_capture("on = \"lit*.png\"\nzero_line = \"lit*.png\"", "step_deg = 2");
  const std::string frames_only = read_text(folder_ / "capture.toml");
  EXPECT_TRUE(complains_of("need a table [zero_line]"));
  folder_.write("capture.toml",
                frames_only + "[zero_line]\nbed_rows = [[0, inf]]\nbed_position_px = 30\n");
  EXPECT_TRUE(complains_of("'zero_line.bed_rows': expected finite numbers"));
  folder_.write("capture.toml",
                frames_only + "[zero_line]\nbed_rows = [[0, 3]]\nbed_position_px = 30\n");
  EXPECT_TRUE(complains_of("against its zero line: only 4 bed rows show the stripe"));
  write_capture("on = \"lit*.png\"", "step_deg = 2");
  folder_.write("capture.toml",
                read_text(folder_ / "capture.toml") + "[zero_line]\nbed_position_px = 30\n");
  EXPECT_TRUE(complains_of("needs its frames named"));
}

/// All lines stand where the bed's line should: every frame then shows the range of that one pixel.
TEST_F(CaptureFile, MeasuresAgainstTheZeroLine) {
  write_capture("on = \"lit*.png\"\nzero_line = \"lit*.png\"", "step_deg = 2");
  folder_.write("capture.toml",
                read_text(folder_ / "capture.toml") +
                    "[zero_line]\nbed_rows = [[0, 47]]\nbed_position_px = 41.5\n");
  const ExtractResult result = extract_scan(read_capture(folder_.path()));
  ASSERT_EQ(result.zero_line_shift.size(), 12U);
  const double z = 60 * 0.05 / (41.5 - 31.5);
  for (int col = 0; col < 12; ++col) {
    const std::size_t middle = result.scan.index(23, col);
    EXPECT_NEAR(result.zero_line_shift[static_cast<std::size_t>(col)], 0, 0.05);
    EXPECT_NEAR(static_cast<double>(result.scan.range[middle]), std::hypot(0.05, z), 0.004 * z);
  }
}

TEST_F(CaptureFile, KeepsWhatLiesInTheWorkVolume) {
  write_capture("on = \"lit*.png\"", "step_deg = 2");
  const std::string good = read_text(folder_ / "capture.toml");
  // z = f s / x: the lines of frames 1 to 12 lie 9.5 to 20.5 px beside the middle.
  const double least = 60 * 50 / 15.0;
  folder_.write("capture.toml", good + "[volume]\nmin_depth_mm = " + std::to_string(least) + "\n");
  const ExtractResult result = extract_scan(read_capture(folder_.path()));
  EXPECT_EQ(result.scan.valid_count(), 6U * 48U);
  EXPECT_EQ(result.outside_volume, 6U * 48U);
  EXPECT_EQ(result.stripes_seen, 12U * 48U);
}

TEST_F(CaptureFile, ReadsPositionsFromCsv) {
  std::string csv = "frame,position_deg\r\n";
  for (int i = 0; i < 12; ++i) csv += std::to_string(i) + ", " + std::to_string(i * 5) + ".5\r\n";
  folder_.write("angles.csv", csv);
  write_capture("on = \"lit*.png\"", "csv = \"angles.csv\"");
  EXPECT_NEAR(read_capture(folder_.path()).positions[3], 15.5 * std::numbers::pi / 180, 1e-12);
  folder_.write("angles.csv", "position_deg\n1\nx\n");
  EXPECT_TRUE(complains_of("angles.csv, line 3: expected a number, got 'x'"));
  folder_.write("angles.csv", "position_mm\n1\n");
  EXPECT_TRUE(complains_of("position_deg or position_rad"));
}

TEST_F(CaptureFile, SaysWhenCountsDiffer) {
  folder_.write("angles.csv", "position_deg\n1\n2\n");
  write_capture("on = \"lit*.png\"", "csv = \"angles.csv\"");
  EXPECT_TRUE(complains_of("2 positions for 12 frames"));
}

TEST_F(CaptureFile, NamesAnUnknownKey) {
  write_capture("on = \"lit*.png\"", "step_degg = 2");
  EXPECT_TRUE(complains_of("'positions.step_deg': missing"));
  write_capture("on = \"lit*.png\"\noof = \"x\"", "step_deg = 2");
  EXPECT_TRUE(complains_of("'frames.oof': unknown key; did you mean 'off'?"));
}

TEST_F(CaptureFile, SaysWhichFrameIsMissingTornOrNoImage) {
  std::filesystem::resize_file(folder_ / "lit3.png",
                               std::filesystem::file_size(folder_ / "lit3.png") / 2);
  EXPECT_TRUE(complains_of("lit3.png' is cut short"));
  folder_.write("lit3.png", "this is no image");
  EXPECT_TRUE(complains_of("lit3.png' is not an image"));
  folder_.write("lit3.png", "");
  EXPECT_TRUE(complains_of("lit3.png' is an empty file"));
  write_image(folder_ / "lit3.png", Image8(10, 20).view());
  EXPECT_TRUE(complains_of("frame 2: expected 64 x 48 px"));
  write_capture("on = \"nothing*.png\"", "step_deg = 2");
  EXPECT_TRUE(complains_of("matches 'nothing*.png'"));
}

TEST_F(CaptureFile, SaysWhenARevoluteAxisHasNoPositions) {
  folder_.write("capture.toml", "rig = \"rig.toml\"\n[frames]\non = \"lit*.png\"\n");
  EXPECT_TRUE(complains_of("needs a table [positions]"));
}

TEST(WorkVolume, KeepsWhatIsWithinItsBounds) {
  WorkVolume volume;
  EXPECT_TRUE(volume.contains({9, 9, 9}, 99));
  volume = {.max_radius = 5, .min_z = -1, .max_z = 2, .min_depth = 0.5, .max_depth = 3};
  EXPECT_TRUE(volume.contains({3, 4, 2}, 3));  // on all its upper bounds
  EXPECT_TRUE(volume.contains({0, 0, -1}, 0.5));
  EXPECT_FALSE(volume.contains({3, 4.1, 0}, 1));
  EXPECT_FALSE(volume.contains({0, 0, 2.1}, 1));
  EXPECT_FALSE(volume.contains({0, 0, -1.1}, 1));
  EXPECT_FALSE(volume.contains({0, 0, 0}, 0.4));
  EXPECT_FALSE(volume.contains({0, 0, 0}, 3.1));
}

TEST_F(CaptureFile, RoundTripsAxisPositions) {
  const std::vector<double> positions = {0, 0.1, -2.0 / 3};
  write_axis_positions(folder_ / "p.csv", positions, AxisKind::kPan);
  EXPECT_EQ(read_axis_positions(folder_ / "p.csv", AxisKind::kPan), positions);
  write_axis_positions(folder_ / "p.csv", positions, AxisKind::kLinear);
  const auto again = read_axis_positions(folder_ / "p.csv", AxisKind::kLinear);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(again[i], positions[i], 1e-15);
}

}  // namespace
}  // namespace facula
