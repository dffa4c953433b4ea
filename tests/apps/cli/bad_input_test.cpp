// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

class BadInput : public testing::Test {
 protected:
  void SetUp() override { make_small_capture(folder_.path()); }

  ProgramRun run(const std::string& line) const { return run_line(line, folder_.path()); }

  /// Spoils something with a shell line, then expects a command to fail with one sentence that
  /// holds the words, and to leave nothing that is called "result".
  void expect_refused(const std::string& spoil,
                      const std::string& line,
                      const std::string& words = "") const {
    ASSERT_EQ(run(spoil).code, 0) << spoil;
    const ProgramRun refused = run(line);
    EXPECT_EQ(refused.code, 1) << spoil << '\n' << refused.err << refused.out;
    EXPECT_EQ(refused.err.rfind("facula ", 0), 0U) << refused.err;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_NE(refused.err.find(words), std::string::npos) << refused.err;
    EXPECT_EQ(refused.out, "");
    EXPECT_FALSE(has_file_like(folder_.path(), "result")) << spoil;
  }

  void expect_capture_refused(const std::string& spoil, const std::string& words = "") const {
    expect_refused(spoil, "facula extract capture --out result.pcd", words);
  }

  TemporaryFolder folder_;
};

TEST_F(BadInput, SoundCaptureIsTaken) {
  EXPECT_EQ(run("facula extract capture --out result.pcd").code, 0);
  EXPECT_TRUE(has_file_like(folder_.path(), "result.pcd"));
}

TEST_F(BadInput, MissingFrame) {
  expect_capture_refused("rm $(ls capture/frames/* | head -n 3 | tail -n 1)");
}

TEST_F(BadInput, TruncatedFrame) {
  expect_capture_refused("truncate -s 300 $(ls capture/frames/* | tail -n 1)");
}

TEST_F(BadInput, EmptyFrame) {
  expect_capture_refused("truncate -s 0 $(ls capture/frames/* | tail -n 1)");
}

TEST_F(BadInput, FrameThatIsNoImage) {
  expect_capture_refused("echo hello > $(ls capture/frames/* | tail -n 1)");
}

TEST_F(BadInput, FrameOfAnotherSize) {
  expect_capture_refused(
      "facula simulate data/scenes/turntable_object.toml --rig data/rigs/ciclop_turntable.toml "
      "--to-deg 0 --out other && cp $(ls other/frames/* | head -n 1) $(ls capture/frames/* | "
      "tail -n 1)");
}

TEST_F(BadInput, FewerFramesThanPositions) {
  expect_capture_refused("rm $(ls capture/frames/* | tail -n 1)");
}

TEST_F(BadInput, FewerPositionsThanFrames) {
  expect_capture_refused("sed -i '$d' capture/positions.csv");
}

TEST_F(BadInput, NanInCalibration) {
  expect_capture_refused("sed -i 's/^fx_px.*/fx_px = nan/' capture/rig.toml", "fx_px");
}

TEST_F(BadInput, LaserPlaneThroughTheCamera) {
  expect_capture_refused("sed -i 's/^distance_mm.*/distance_mm = 0/' capture/rig.toml");
}

TEST_F(BadInput, MisspeltKeyIsNamedWithTheNearestOne) {
  expect_capture_refused("sed -i 's/^fx_px/fx_xp/' capture/rig.toml", "fx_px");
}

TEST_F(BadInput, MisspeltOptionalKeyIsNamedWithTheNearestOne) {
  expect_capture_refused("sed -i 's/^k1 /k11 /' capture/rig.toml", "k1");
}

TEST_F(BadInput, TornToml) {
  expect_capture_refused("echo '[[[' >> capture/capture.toml");
}

TEST_F(BadInput, PcdWithWrongCount) {
  expect_refused("facula extract capture --out s.pcd && truncate -s -100 s.pcd",
                 "facula mesh s.pcd --out result.ply");
}

TEST_F(BadInput, PlyWithWrongCount) {
  expect_refused(
      "facula extract capture --out s.ply && sed -i 's/^element vertex .*/element "
      "vertex 99999999/' s.ply",
      "facula map s.ply --out result.bt");
}

TEST_F(BadInput, HugeCountInPcdHeader) {
  expect_refused(
      "facula extract capture --out s.pcd && sed -i 's/^WIDTH .*/WIDTH "
      "4000000000/;s/^POINTS .*/POINTS 1920000000000/' s.pcd",
      "facula info s.pcd");
}

TEST_F(BadInput, ScanWithoutPoints) {
  // The head looks away from the wall, so the true scan is empty.
  expect_refused(
      "facula simulate data/scenes/flat_wall.toml --rig data/rigs/head_fs1500.toml "
      "--to-deg 4 --step-deg 2 --yaw-deg 180 --out away && cp away/truth.pcd s.pcd",
      "facula mesh s.pcd --out result.ply");
  expect_refused("true", "facula mesh s.pcd --method grid --out result.ply", "empty");
  expect_refused("true", "facula map s.pcd --out result.bt");
  expect_refused("true", "facula measure planes s.pcd --out result.csv");
}

TEST_F(BadInput, FramesWithoutALaserLine) {
  expect_refused("true", "facula extract capture --min-snr 100000 --out result.pcd", "laser line");
}

TEST_F(BadInput, VolumeWithoutPoints) {
  expect_capture_refused("printf '[volume]\nmin_z_mm = 900000\n' >> capture/capture.toml",
                         "volume");
}

TEST_F(BadInput, SingleStripeHoldsNoSurface) {
  expect_refused(
      "facula simulate data/scenes/flat_wall.toml --rig data/rigs/head_fs1500.toml "
      "--to-deg 0 --out one && facula extract one --out one.pcd",
      "facula mesh one.pcd --out result.ply",
      "stripe");
  expect_refused("true", "facula mesh one.pcd --no-filter --out result.ply", "stripe");
  expect_refused("true", "facula mesh one.pcd --method grid --out result.ply", "stripe");
  expect_refused("true", "facula measure planes one.pcd --min-points 50", "stripe");
}

TEST_F(BadInput, CellsTooSmallForTheMapToReachThePoints) {
  expect_refused("facula extract capture --out s.pcd",
                 "facula map s.pcd --resolution-mm 1e-9 --out result.bt",
                 "--resolution-mm");
}

TEST_F(BadInput, GridThatCannotBeMadeLeavesNoMapEither) {
  expect_refused("facula extract capture --out s.pcd",
                 "facula map s.pcd --min-height-m 900 --max-height-m 901 --out result.bt --grid "
                 "result.yaml",
                 "heights");
}

TEST_F(BadInput, HeadBeyondTheRayTracersNumbers) {
  expect_refused("true",
                 "facula simulate data/scenes/flat_wall.toml --rig data/rigs/head_fs1500.toml "
                 "--to-deg 0 --position-mm 1e308 0 0 --out result",
                 "position");
}

TEST_F(BadInput, ReferenceMeshIsReadBeforeTheWork) {
  expect_refused("facula extract capture --out s.pcd && echo ply > torn.ply",
                 "facula mesh s.pcd --compare torn.ply --out result.ply",
                 "torn.ply");
}

TEST_F(BadInput, FileOfTheWrongKind) {
  expect_refused("true", "facula map capture --out result.bt", "capture");
  expect_refused("true", "facula mesh capture/rig.toml --out result.ply", "rig");
}

TEST_F(BadInput, OutputWithUnknownExtension) {
  expect_refused("true", "facula extract capture --out result.las", ".pcd");
}

TEST_F(BadInput, OutputIntoMissingFolder) {
  expect_refused("true", "facula extract capture --out no/such/result.pcd", "no/such");
}

TEST_F(BadInput, OutputIntoAFile) {
  expect_refused("touch plain", "facula extract capture --out plain/result.pcd", "plain");
}

TEST_F(BadInput, OutputFolderThatIsAFile) {
  expect_refused("touch plain",
                 "facula simulate data/scenes/flat_wall.toml --rig data/rigs/head_fs1500.toml "
                 "--to-deg 0 --out plain --overwrite",
                 "the file 'plain'");
}

TEST_F(BadInput, PipeIsNotReplacedByAFile) {
  expect_refused("mkfifo pipe.json", "facula info capture --json pipe.json", "pipe");
  EXPECT_EQ(run("test -p pipe.json").code, 0);
}

TEST_F(BadInput, TooLittleMemoryIsASentence) {
  ASSERT_EQ(run("facula extract capture --out s.pcd").code, 0);
  expect_refused("true", "ulimit -v 3000000; facula map s.pcd --resolution-mm 0.5 --out result.bt");
}

}  // namespace
}  // namespace facula
