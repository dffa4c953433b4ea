// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/tests/apps/cli/program_run.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

const std::string kBoard = " --board charuco --cols 10 --rows 7 --spacing-mm 25 ";

// Grey sees a line in the print of every view, the unlit one too, and so in more views than red
// excess does; what it sees lies in no sheet.
TEST(CalibrateLaser, DoesNotTakeThePrintOfABoardForTheLine) {
  const TemporaryFolder folder;
  const ProgramRun made = run_line(
      "facula calibrate board --rig data/rigs/head_fs760.toml" + kBoard + "--views 5 --lit --out b",
      folder.path());
  ASSERT_EQ(made.code, 0) << made.err;
  const ProgramRun run = run_line(
      "facula calibrate laser b/lit_0.png b/lit_1.png b/lit_2.png b/lit_3.png b/dark_4.png --rig "
      "data/rigs/head_fs760.toml --laser red" +
          kBoard + "--out rig.toml",
      folder.path());
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find("Left out: 'dark_4.png'"), std::string::npos) << run.out;
  const Rig rig = read_rig(folder.path() / "rig.toml");
  const LaserPlane& truth = rig.lasers.front();  // the rig's own, of another name, stays
  const LaserPlane& found = rig.lasers.back();
  ASSERT_EQ(found.name, "red");
  EXPECT_LT(std::acos(std::min(1.0, truth.normal.dot(found.normal))), 2e-3);
  EXPECT_NEAR(truth.distance, found.distance, 1e-3);
}

}  // namespace
}  // namespace facula
