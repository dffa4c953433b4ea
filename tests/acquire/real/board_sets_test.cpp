// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/camera_calibration.hpp>
#include <facula/acquire/calibrate/laser_calibration.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/tests/acquire/calibrate/board_scene.hpp>
#include <facula/tests/acquire/real/board_pictures.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace facula {
namespace {

using std::filesystem::path;

std::vector<path> sorted_files(const path& folder) {
  std::vector<path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

TEST(PotSet, GivesAFlatterSheetThanThePublishedHalfMillimetre) {
  FACULA_REQUIRE_REAL_DATA(set, "laser/caltag_turntable_pot");
  // Every other of the 14 pictures: finding a board takes half a second.
  auto files = sorted_files(set / "laser_plane_color");
  for (std::size_t i = 1; i < files.size(); ++i)
    files.erase(files.begin() + static_cast<std::ptrdiff_t>(i));
  // The author used 10 x 7 of the 11 x 7 corners.
  const Board board{.kind = BoardKind::kChessboard, .cols = 11, .rows = 7, .spacing = 0.021167};
  const auto views = find_all(board, files);
  const CameraCalibration camera = calibrate_camera(board, views);
  EXPECT_EQ(camera.views.size(), 7U);
  EXPECT_LT(camera.held_out_rms, 0.21);
  std::vector<BoardPose> poses;
  std::vector<LaserLineView> lines;
  for (std::size_t i = 0; i < files.size(); ++i) {
    poses.push_back(pose_of(locate_board(board, views[i], camera.camera)));
    lines.push_back(find_line_on_board(read_image(files[i]).view(),
                                       {},
                                       board,
                                       camera.camera,
                                       poses.back().camera_from_board,
                                       BoardLineOptions{}));
    lines.back().view = i;
  }
  const LaserCalibration sheet = calibrate_laser(camera.camera, poses, lines);
  RecordProperty("held_out_um", static_cast<int>(1e6 * sheet.held_out_rms));
  EXPECT_EQ(sheet.views.size(), 7U);
  EXPECT_LT(sheet.held_out_rms, 0.2e-3);  // 0.50 mm is published
}

TEST(CiclopSet, GivesTheNotedCamera) {
  FACULA_REQUIRE_REAL_DATA(set, "laser/ciclop_bust_and_pattern");
  const Board board{.kind = BoardKind::kChessboard, .cols = 11, .rows = 6, .spacing = 0.013};
  const CameraCalibration result =
      calibrate_camera(board, find_all(board, sorted_files(set / "camera_board")));
  EXPECT_EQ(result.views.size(), 9U);
  EXPECT_LE(result.rms, 0.26);
  // The author's 16 pictures, turned to portrait: 1430.39 1429.66 478.03 and 1280 - 1 - 636.40.
  EXPECT_LT(std::abs(result.camera.fx - 1429.66), 6 * std::sqrt(result.covariance(0, 0)));
  EXPECT_LT(std::abs(result.camera.cx - 478.03), 4 * std::sqrt(result.covariance(2, 2)));
  EXPECT_LT(std::abs(result.camera.cy - 642.6), 4 * std::sqrt(result.covariance(3, 3)));
}

TEST(PrinterBedSet, IsCalledWeak) {
  FACULA_REQUIRE_REAL_DATA(set, "laser/printerbed_1mm_stairs");
  const Board board{.kind = BoardKind::kChessboard, .cols = 5, .rows = 5, .spacing = 0.005};
  const CameraCalibration result =
      calibrate_camera(board, find_all(board, sorted_files(set / "camera_board")));
  EXPECT_TRUE(one_says(result.warnings, "too little tilt"));
  EXPECT_TRUE(one_says(result.warnings, "the focal length is known to"));
  EXPECT_GT(std::sqrt(result.covariance(0, 0)), 30);
  // What such a set does know is the scale, 10.63 px/mm by the author's own reckoning.
  const CalibratedView& first = result.views.front();
  EXPECT_NEAR(1e-3 * result.camera.fx / first.camera_from_board.translation.z(), 10.63, 0.25);
}

}  // namespace
}  // namespace facula
