// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/calibration_set_file.hpp>
#include <facula/acquire/calibrate/synthetic_set.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/tests/support/matchers.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

CalibrationSet small_set() {
  SyntheticSetOptions options;
  options.hand_views = 3;
  options.placements = 2;
  options.boards = 2;
  return synthesize_calibration_set(read_rig(shipped_data("rigs") / "ciclop_turntable.toml"),
                                    options);
}

TEST(CalibrationSetFile, ReadsWhatItWrites) {
  const TemporaryFolder folder;
  const CalibrationSet set = small_set();
  write_calibration_set(folder.path(), set);
  const CalibrationSetFile file = read_calibration_set(folder.path());
  EXPECT_EQ(file.set.axis, set.axis);
  EXPECT_EQ(file.set.lasers, set.lasers);
  ASSERT_EQ(file.set.boards.size(), 2U);
  EXPECT_NEAR(file.set.boards[0].spacing, set.boards[0].spacing, 1e-12);
  ASSERT_EQ(file.set.views.size(), set.views.size());
  for (std::size_t v = 0; v < set.views.size(); ++v) {
    const JointView& a = set.views[v];
    const JointView& b = file.set.views[v];
    EXPECT_EQ(a.board, b.board);
    EXPECT_EQ(a.points.name, b.points.name);
    EXPECT_EQ(a.points.ids, b.points.ids);
    EXPECT_EQ(b.points.image_width, 1280);
    ASSERT_EQ(a.position.has_value(), b.position.has_value());
    if (a.position) {
      EXPECT_NEAR(*a.position, *b.position, 1e-9);
      EXPECT_EQ(a.placement, b.placement);
    }
    ASSERT_EQ(a.lines.size(), b.lines.size());
    for (std::size_t l = 0; l < a.lines.size(); ++l) {
      ASSERT_EQ(a.lines[l].pixels.size(), b.lines[l].pixels.size());
      EXPECT_LT((a.lines[l].pixels[0] - b.lines[l].pixels[0]).norm(), 1e-7);
    }
  }
}

TEST(CalibrationSetFile, TakesPlacesOnTheBoardInsteadOfNumbers) {
  const TemporaryFolder folder;
  folder.write("c.csv", "view,board_x_mm,board_y_mm,x_px,y_px\na,25,50,10,20\na,0,0,5,6\n");
  const auto file = folder.write("calibration.toml",
                                 "image_width_px = 640\nimage_height_px = 480\n[[board]]\ncols = "
                                 "4\nrows = 3\nspacing_mm = 25\n[[views]]\ncorners = \"c.csv\"\n");
  const CalibrationSet set = read_calibration_set(file).set;
  ASSERT_EQ(set.views.size(), 1U);
  EXPECT_EQ(set.views[0].points.ids, (std::vector<int>{0, 9}));
  EXPECT_EQ(set.views[0].points.pixels[1], Eigen::Vector2d(10, 20));
}

TEST(CalibrationSetFile, SaysWhatIsWrongAndWhere) {
  const TemporaryFolder folder;
  folder.write("c.csv", "view,point,x_px,y_px\na,0,10,20\n");
  folder.write("far.csv", "view,point,x_px,y_px\na,12,10,20\n");
  folder.write("twice.csv", "view,point,x_px,y_px\na,1,10,20\na,1,10,21\n");
  folder.write("off.csv", "view,board_x_mm,board_y_mm,x_px,y_px\na,25,57,10,20\n");
  folder.write("l.csv", "view,laser,x_px,y_px,sigma_px\nb,red,1,2,0.1\n");
  folder.write("p.csv", "position_deg\n1\n2\n");
  const std::string board = "[[board]]\ncols = 4\nrows = 3\nspacing_mm = 25\n";
  const auto complaint = [&](const std::string& text) {
    const auto file = folder.write("calibration.toml", text);
    return error_of([&] { read_calibration_set(file); });
  };
  const std::string size = "image_width_px = 640\nimage_height_px = 480\n";
  EXPECT_NE(complaint("[[views]]\ncorners = \"c.csv\"\n").find("[[board]]"), std::string::npos);
  EXPECT_NE(complaint(board).find("[[views]]"), std::string::npos);
  EXPECT_NE(complaint(board + "[[views]]\nboard = 1\n").find("expected corners"),
            std::string::npos);
  EXPECT_NE(complaint(board + "[[views]]\ncorners = \"c.csv\"\n").find("image_width_px"),
            std::string::npos);
  EXPECT_NE(complaint(size + board + "[[views]]\nboard = 2\ncorners = \"c.csv\"\n").find("from 1"),
            std::string::npos);
  EXPECT_NE(complaint(size + board + "[[views]]\nboard = 0\ncorners = \"c.csv\"\n").find("from 1"),
            std::string::npos);
  EXPECT_NE(complaint(size + board + "[[views]]\ncorners = \"far.csv\"\n").find("0 to 11"),
            std::string::npos);
  EXPECT_NE(complaint(size + board + "[[views]]\ncorners = \"twice.csv\"\n").find("twice"),
            std::string::npos);
  EXPECT_NE(complaint(size + board + "[[views]]\ncorners = \"off.csv\"\n").find("7 mm off"),
            std::string::npos);
  EXPECT_NE(complaint(size + "lasers = [\"red\"]\n" + board +
                      "[[views]]\ncorners = \"c.csv\"\nlines = \"l.csv\"\n")
                .find("no view 'b'"),
            std::string::npos);
  EXPECT_NE(complaint(size + "axis = \"pan\"\n" + board +
                      "[[views]]\ncorners = \"c.csv\"\npositions = \"p.csv\"\n")
                .find("a row per view"),
            std::string::npos);
  EXPECT_NE(complaint("axis = \"round\"\n" + board).find("turntable"), std::string::npos);
  EXPECT_NE(complaint(board + "[[views]]\ncornes = \"c.csv\"\n").find("did you mean 'corners'"),
            std::string::npos);
}

}  // namespace
}  // namespace facula
