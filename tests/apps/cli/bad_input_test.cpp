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

TEST_F(BadInput, TablesThatDecideNoRangeModel) {
  const auto refused = [this](const std::string& rows, const std::string& words) {
    expect_refused("printf 'distance_mm,position_px\\n" + rows + "' > t.csv",
                   "facula calibrate range t.csv --rig data/rigs/head_fs760.toml --out result.toml",
                   words);
  };
  refused("", "the header alone");
  refused("1000,300\\n2000,400\\n", "different distances");
  refused("1000,300\\n1000,300\\n1000,301\\n", "one distance");
  refused("500,200\\n1000,200\\n2000,200\\n", "does not move");
  refused("1000,300\\n2000,375\\n3000,nan\\n", "line 4");
  refused("-500,200\\n1000,300\\n2000,350\\n", "above 0");
  refused("500,200\\n1000,300\\n2000,250\\n3000,410\\n", "infinity");
}

TEST_F(BadInput, TablesThatDecideNoProfile) {
  const auto refused = [this](const std::string& rows, const std::string& words) {
    expect_refused("printf '" + rows + "' > t.csv",
                   "facula calibrate profile t.csv --rig data/rigs/profile_bench.toml --degree 4 "
                   "--out result.toml",
                   words);
  };
  refused("position_px,size_mm\\n1,5\\n2,6\\n3,7\\n", "degree 4");
  refused("position_px,size_mm\\n1,5\\n1,6\\n1,7\\n", "different positions");
  refused("across_mm,height_mm,x_px,y_px\\n0,0,1,1\\n1,0,2,1\\n2,0,3,1\\n3,0,4,1\\n4,0,5,1\\n",
          "one line");
}

TEST_F(BadInput, TablesThatDecideNoTwoLineHead) {
  const auto refused = [this](const std::string& rows, const std::string& words) {
    expect_refused("printf 'distance_mm,separation_px\\n" + rows + "' > t.csv",
                   "facula calibrate two-line t.csv --rig data/rigs/two_line_air.toml --out "
                   "result.toml",
                   words);
  };
  refused("1000,50\\n", "two or more distances");
  refused("1000,50\\n1000,50\\n", "equal");
  refused("1000,0\\n2000,0\\n", "above 0");
  refused("1000,50\\n2000,100\\n3000,150\\n", "grow with the distance");
}

TEST_F(BadInput, WallsThatDecideNoCompensation) {
  const auto refused = [this](const std::string& rows, const std::string& words) {
    expect_refused("printf '" + rows + "' > t.csv",
                   "facula calibrate compensation t.csv --rig data/rigs/head_fs760.toml --out "
                   "result.toml",
                   words);
  };
  refused("true_m,top_px,centre_px,bottom_px\\n1,100,101,102\\n", "two walls");
  refused("true_m,top_px,centre_px,bottom_px\\n1,9,9,9\\n2,9,9,9\\n", "out of order");
  refused("distance_mm,frame\\n1000,none.png\\n", "none.png");
}

TEST_F(BadInput, PicturesThatDecideNoCameraAndNoSheet) {
  const std::string board = " --cols 9 --rows 6 --spacing-mm 12 ";
  const std::string rig = " --rig data/rigs/ciclop_turntable.toml ";
  const auto refused = [&](const std::string& command, const std::string& words) {
    expect_refused("true", "facula calibrate " + command + " --out result.toml", words);
  };
  // Small pictures where they do: finding a board takes its time.
  const std::string small = " --rig data/rigs/head_fs1500.toml ";
  ASSERT_EQ(run("facula calibrate board" + rig + board + "--views 2 --lit --out b").code, 0);
  ASSERT_EQ(run("facula calibrate board" + small + board + "--views 2 --out s").code, 0);
  ASSERT_EQ(run("facula calibrate board" + small + board + "--views 3 --tilt-deg 0 --out f").code,
            0);
  refused("camera s/dark_0.png" + board, "3 pictures or more");
  refused("camera s/dark_0.png s/dark_1.png" + board, "3 pictures or more");
  refused("camera s/dark_0.png s/dark_0.png s/dark_0.png" + board, "parallel to each other");
  refused("camera f/dark_0.png f/dark_1.png f/dark_2.png" + board, "parallel to each other");
  refused("camera b/dark_0.png --cols 8 --rows 6 --spacing-mm 12", "9 x 6 points instead of 8 x 6");
  refused("laser b/lit_0.png" + board + rig, "2 pictures or more");
  refused("laser b/lit_0.png b/lit_0.png" + board + rig, "hold the board at several distances");
  refused("laser b/dark_0.png b/dark_1.png" + board + rig, "line");
}

TEST_F(BadInput, TooLittleMemoryIsASentence) {
  ASSERT_EQ(run("facula extract capture --out s.pcd").code, 0);
  expect_refused("true", "ulimit -v 3000000; facula map s.pcd --resolution-mm 0.2 --out result.bt");
}

}  // namespace
}  // namespace facula
