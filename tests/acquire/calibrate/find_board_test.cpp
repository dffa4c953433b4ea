// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/board.hpp>
#include <facula/acquire/calibrate/board_detection.hpp>
#include <facula/acquire/calibrate/board_order.hpp>
#include <facula/acquire/calibrate/render_board.hpp>
#include <facula/tests/acquire/calibrate/board_scene.hpp>
#include <facula/tests/support/matchers.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace facula {
namespace {

Board board_of_kind(BoardKind kind) {
  Board board{.kind = kind, .cols = 8, .rows = 5, .spacing = 0.016};
  if (kind == BoardKind::kCircles) board = {.kind = kind, .cols = 7, .rows = 5, .spacing = 0.018};
  if (kind == BoardKind::kAsymmetricCircles) {
    board = {.kind = kind, .cols = 4, .rows = 9, .spacing = 0.011, .circle_diameter = 0.009};
  }
  return board;
}

Image8 picture(const Board& board, int place, const RenderBoardOptions& options = {}) {
  return render_board(board, vga_camera(), board_place(board, place), {}, options);
}

Image8 mirrored(const Image8& image) {
  Image8 out(image.rows, image.cols, image.channels);
  for (int r = 0; r < image.rows; ++r) {
    for (int c = 0; c < image.cols; ++c) {
      for (int k = 0; k < 3; ++k)
        out.row(r)[3 * c + k] = image.row(r)[3 * (image.cols - 1 - c) + k];
    }
  }
  return out;
}

/// Distance of the points found from where they were rendered, root mean square [px].
double rms_error(const Board& board, const BoardView& view, int place) {
  double squares = 0;
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const Eigen::Vector3d x = board_place(board, place) * board.point(view.ids[i]);
    squares += (view.pixels[i] - vga_camera().project(x)).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(view.ids.size()));
}

class EveryBoard : public testing::TestWithParam<BoardKind> {};

TEST_P(EveryBoard, IsFoundWhereItWasRendered) {
  const Board board = board_of_kind(GetParam());
  const bool circles =
      GetParam() == BoardKind::kCircles || GetParam() == BoardKind::kAsymmetricCircles;
  for (int place = 0; place < 3; ++place) {
    const BoardView view = find_board(picture(board, place).view(), board, "a picture");
    ASSERT_TRUE(view.found()) << view.failure;
    // A marker that is too slanted to be read takes corners of a ChArUco board with it.
    const bool in_part = GetParam() == BoardKind::kCharuco;
    EXPECT_GE(view.ids.size(), in_part ? board.size() * 9 / 10 : board.size());
    EXPECT_EQ(view.image_width, 640);
    // A tilted circle's centre is off by perspective (see docs/calibration.md).
    // Markers leave a ChArUco corner a window of 3 px only.
    const double bound = circles ? 0.25 : GetParam() == BoardKind::kCharuco ? 0.15 : 0.06;
    EXPECT_LT(rms_error(board, view, place), bound) << "place " << place;
    EXPECT_GT(view.sharpness, 1.0);
    EXPECT_LT(view.sharpness, 4.0);
    EXPECT_EQ(view.clipped_share, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Kind,
                         EveryBoard,
                         testing::Values(BoardKind::kChessboard,
                                         BoardKind::kCircles,
                                         BoardKind::kAsymmetricCircles,
                                         BoardKind::kCharuco));

TEST(FindBoard, MeasuresTheWidthOfBlurredEdges) {
  const Board board = board_of_kind(BoardKind::kChessboard);
  for (const double blur : {1.0, 2.0, 3.0}) {
    const BoardView view = find_board(picture(board, 1, {.blur = blur}).view(), board, "blurred");
    ASSERT_TRUE(view.found()) << view.failure;
    // 10 % to 90 % of a Gaussian's integral are 2.563 sigma; a pixel's own width adds 1/12 px^2.
    EXPECT_NEAR(view.sharpness, 2.563 * std::sqrt(blur * blur + 1.0 / 12), 0.12 * 2.563 * blur);
  }
}

TEST(FindBoard, SaysThatAPictureIsBlurred) {
  const Board board = board_of_kind(BoardKind::kChessboard);
  const BoardView view = find_board(picture(board, 1, {.blur = 4.8}).view(), board, "blurred");
  EXPECT_FALSE(view.found());
  EXPECT_TRUE(says(view.failure, "blurred: edges"));
}

TEST(FindBoard, SaysHowManyPointsItSawInstead) {
  const Board shown{.kind = BoardKind::kChessboard, .cols = 6, .rows = 4, .spacing = 0.02};
  Board asked = shown;
  asked.cols = 9;
  asked.rows = 6;
  const Image8 image = picture(shown, 1);
  EXPECT_TRUE(says(find_board(image.view(), asked, "p").failure, "6 x 4 points instead of 9 x 6"));
  const Board circles{.kind = BoardKind::kCircles, .cols = 6, .rows = 4, .spacing = 0.02};
  Board more = circles;
  more.cols = 7;
  EXPECT_TRUE(says(find_board(picture(circles, 1).view(), more, "p").failure,
                   "6 x 4 points instead of 7 x 4"));
}

TEST(FindBoard, SaysThatAPictureIsMirrored) {
  const Board board = board_of_kind(BoardKind::kCharuco);
  const BoardView view = find_board(mirrored(picture(board, 1)).view(), board, "p");
  EXPECT_TRUE(says(view.failure, "mirrored"));
}

TEST(FindBoard, SaysThatAPictureIsClippedOrWithoutContrast) {
  const Board board = board_of_kind(BoardKind::kChessboard);
  const Image8 white =
      picture(board, 1, {.black = 400, .white = 900, .surroundings = 400, .noise = 0});
  EXPECT_TRUE(says(find_board(white.view(), board, "p").failure, "clipped: 1"));
  const Image8 dark = picture(board, 1, {.black = 2, .white = 3, .surroundings = 2});
  EXPECT_TRUE(says(find_board(dark.view(), board, "p").failure, "no contrast"));
}

TEST(FindBoard, SaysThatThereIsNothingLikeABoard) {
  Image8 noise(480, 640, 3);
  Random random(3);
  for (auto& v : noise.pixels) v = static_cast<std::uint8_t>(random.below(200));
  for (const BoardKind kind : {BoardKind::kChessboard, BoardKind::kCircles, BoardKind::kCharuco}) {
    EXPECT_TRUE(says(find_board(noise.view(), board_of_kind(kind), "p").failure,
                     "nothing like '" + to_string(kind)));
  }
}

TEST(FindBoard, TurnsRowsToTheRightWhereThePrintLeavesAQuarterOpen) {
  const Image8 black(100, 100);
  GridSeen grid{4, 4, {}};
  for (int i = 0; i < 16; ++i) grid.pixels.emplace_back(80 - 20 * (i / 4), 10 + 20 * (i % 4));
  ASSERT_TRUE(order_like_board(black.view(), {.cols = 4, .rows = 4}, grid));
  EXPECT_EQ(grid.pixels.front(), Eigen::Vector2d(20, 10));
  EXPECT_EQ(grid.pixels[3], Eigen::Vector2d(80, 10));
}

TEST(FindBoard, SeesACharucoBoardInPart) {
  const Board board = board_of_kind(BoardKind::kCharuco);
  RigidTransform pose = board_place(board, 0);
  pose.translation.x() += 0.09;  // a third of it out of the picture
  const BoardView view = find_board(render_board(board, vga_camera(), pose, {}).view(), board, "p");
  ASSERT_TRUE(view.found()) << view.failure;
  EXPECT_LT(view.ids.size(), board.size());
  EXPECT_GE(view.ids.size(), 10U);
  for (std::size_t i = 0; i < view.ids.size(); ++i) {
    const Eigen::Vector2d truth = vga_camera().project(pose * board.point(view.ids[i]));
    EXPECT_LT((view.pixels[i] - truth).norm(), 0.3) << view.ids[i];
  }
  pose.translation.x() += 0.045;
  const BoardView less = find_board(render_board(board, vga_camera(), pose, {}).view(), board, "p");
  EXPECT_FALSE(less.found());
  EXPECT_TRUE(says(less.failure, "too few corners"));
}

TEST(FindBoard, FindsAChessboardUnderARedLine) {
  const Board board = board_of_kind(BoardKind::kChessboard);
  const LaserPlane laser{.normal = Eigen::Vector3d(0.95, 0.05, 0.3).normalized(), .distance = 0.11};
  const Image8 image =
      render_board(board, vga_camera(), board_place(board, 2), {laser}, {.laser_level = 400});
  const BoardView view = find_board(image.view(), board, "p");
  ASSERT_TRUE(view.found()) << view.failure;
}

TEST(FindBoard, RefusesEmptyPicturesAndImpossibleBoards) {
  const Board board = board_of_kind(BoardKind::kChessboard);
  EXPECT_TRUE(says(error_of([&] { find_board({}, board, "void.png"); }), "'void.png' is empty"));
  const Image8 image(48, 64, 1);
  Board wrong = board;
  wrong.spacing = 0;
  EXPECT_TRUE(says(error_of([&] { find_board(image.view(), wrong, "p"); }), "spacing_mm"));
  wrong = board;
  wrong.cols = 1;
  EXPECT_TRUE(says(error_of([&] { find_board(image.view(), wrong, "p"); }), "columns"));
  wrong = board_of_kind(BoardKind::kCharuco);
  wrong.dictionary = "9x9_7";
  EXPECT_TRUE(says(error_of([&] { find_board(image.view(), wrong, "p"); }), "9x9_7"));
  wrong.dictionary = "4x4_50";
  wrong.cols = 20;
  wrong.rows = 20;
  EXPECT_TRUE(says(error_of([&] { find_board(image.view(), wrong, "p"); }), "a larger one"));
  EXPECT_TRUE(says(error_of([] { board_kind_from_name("chess"); }), "chess"));
}

}  // namespace
}  // namespace facula
