// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

const std::string kGoodRig = R"(name = "test"
[camera]
width_px = 640
height_px = 480
fx_px = 600
fy_px = 601.5
cx_px = 319.5
cy_px = 239.5
k1 = -0.05
[[laser]]
normal = [0.8, 0, 0.6]
distance_mm = 200
[axis]
kind = "pan"
translation_mm = [60, 0, 0]
)";

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = kGoodRig;
  text.replace(text.find(from), from.size(), to);
  return text;
}

std::string complaint_about(const std::string& text) {
  const TemporaryFolder folder;
  const auto file = folder.write("rig.toml", text);
  return error_of([&] { read_rig(file); });
}

TEST(RigFile, ReadsUnitsFromTheKeys) {
  const TemporaryFolder folder;
  const Rig rig = read_rig(folder.write("rig.toml", kGoodRig));
  EXPECT_EQ(rig.camera.width, 640);
  EXPECT_EQ(rig.camera.fy, 601.5);
  EXPECT_DOUBLE_EQ(rig.lasers.at(0).distance, 0.2);
  EXPECT_EQ(rig.axis.kind, AxisKind::kPan);
  EXPECT_TRUE(is_near_point(rig.axis.scan_from_camera.translation, {0.06, 0, 0}, 1e-15));
}

TEST(RigFile, WritesWhatItReads) {
  const TemporaryFolder folder;
  for (const char* set :
       {"caltag_turntable_pot", "printerbed_1mm_stairs", "ciclop_bust_and_pattern"}) {
    Rig rig = read_rig(shipped_data("captures") / set / "rig.toml");
    rig.name = "a \"quoted\"\nname \\ of two lines";
    write_rig(folder / "copy.toml", rig);
    const Rig copy = read_rig(folder / "copy.toml");
    EXPECT_EQ(copy.name, rig.name);
    EXPECT_EQ(copy.camera.fx, rig.camera.fx);
    EXPECT_EQ(copy.camera.k2, rig.camera.k2);
    EXPECT_EQ(copy.lasers.at(0).name, rig.lasers.at(0).name);
    EXPECT_LT((copy.lasers.at(0).normal - rig.lasers.at(0).normal).norm(), 1e-15);
    EXPECT_NEAR(copy.lasers.at(0).distance, rig.lasers.at(0).distance, 1e-15);
    EXPECT_TRUE(is_near_pose(copy.axis.scan_from_camera, rig.axis.scan_from_camera, 1e-12, 1e-15));
    EXPECT_EQ(copy.axis.direction, rig.axis.direction);
  }
}

TEST(RigFile, NamesAMisspeltKeyAndTheNearOne) {
  const std::string said = complaint_about(replaced("cx_px", "cx_pix"));
  EXPECT_NE(said.find("cx_px"), std::string::npos) << said;
  const std::string extra = complaint_about(replaced("k1 =", "k1 = 0\nkk2 ="));
  EXPECT_NE(extra.find("'camera.kk2': unknown key; did you mean 'k2'?"), std::string::npos)
      << extra;
}

TEST(RigFile, SaysWhichValueIsMissingOrOfTheWrongKind) {
  EXPECT_NE(complaint_about(replaced("fx_px = 600\n", "")).find("'camera.fx_px': missing"),
            std::string::npos);
  EXPECT_NE(complaint_about(replaced("fx_px = 600", "fx_px = \"600\"")).find("expected a number"),
            std::string::npos);
  EXPECT_NE(complaint_about(replaced("width_px = 640", "width_px = 640.5")).find("whole number"),
            std::string::npos);
  EXPECT_NE(complaint_about(replaced("[0.8, 0, 0.6]", "[0.8, 0]")).find("expected 3 numbers"),
            std::string::npos);
  EXPECT_NE(complaint_about(replaced("\"pan\"", "\"pam\"")).find("turntable"), std::string::npos);
}

TEST(RigFile, RefusesNanAndPlanesThroughTheCameraCentre) {
  EXPECT_NE(complaint_about(replaced("fx_px = 600", "fx_px = nan")).find("finite"),
            std::string::npos);
  EXPECT_NE(complaint_about(replaced("distance_mm = 200", "distance_mm = 0"))
                .find("passes through the camera centre"),
            std::string::npos);
  EXPECT_NE(complaint_about(replaced("[0.8, 0, 0.6]", "[0, 0, 0]")).find("length"),
            std::string::npos);
}

TEST(RigFile, RefusesPosesBeyondAnyScanner) {
  EXPECT_NE(complaint_about(replaced("[60, 0, 0]", "[60, 1e300, 0]"))
                .find("translation_mm': expected lengths below 1e9 mm, got one of 1e+300"),
            std::string::npos);
}

TEST(RigFile, SaysWhereTheSyntaxBreaks) {
  EXPECT_NE(complaint_about(replaced("fx_px = 600", "fx_px = = 600")).find("line 5"),
            std::string::npos);
}

TEST(RigFile, SaysWhenThereIsNoFile) {
  EXPECT_NE(error_of([] { read_rig("/nowhere/rig.toml"); }).find("/nowhere/rig.toml"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
