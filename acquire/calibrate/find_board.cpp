// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/board_detection.hpp>
#include <facula/acquire/calibrate/board_order.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/channel.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <locale>
#include <numeric>
#include <sstream>

namespace facula {
namespace {

constexpr int kLeastCorners = 6;  ///< of a ChArUco board: fewer give no trustworthy pose

template <typename... Parts>
std::string clause(const Parts&... parts) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(2);
  (text << ... << parts);
  return text.str();
}

/// The pictures to look in: a red line over a board breaks grey and red first.
std::vector<Image8> channels_of(ImageView8 image) {
  std::vector<Image8> channels;
  channels.push_back(extract_channel(image, Channel::kGrey));
  if (image.channels == 1) return channels;
  for (const Channel channel : {Channel::kGreen, Channel::kBlue, Channel::kRed}) {
    channels.push_back(extract_channel(image, channel));
  }
  return channels;
}

Image8 half_size(ImageView8 grey) {
  Image8 half(grey.rows / 2, grey.cols / 2, 1);
  for (int r = 0; r < half.rows; ++r) {
    for (int c = 0; c < half.cols; ++c) {
      const std::uint8_t* upper = grey.row(2 * r) + 2 * c;
      const std::uint8_t* lower = grey.row(2 * r + 1) + 2 * c;
      half.row(r)[c] =
          static_cast<std::uint8_t>((upper[0] + upper[1] + lower[0] + lower[1] + 2) / 4);
    }
  }
  return half;
}

Image8 mirrored(ImageView8 grey) {
  Image8 flipped(grey.rows, grey.cols, 1);
  for (int r = 0; r < grey.rows; ++r) {
    std::reverse_copy(grey.row(r), grey.row(r) + grey.cols, flipped.row(r));
  }
  return flipped;
}

std::optional<GridSeen> find_grid(ImageView8 grey, const Board& board) {
  if (board.kind == BoardKind::kChessboard) return find_chessboard(grey, board.cols, board.rows);
  return find_circle_grid(grey, board);
}

/// Fills ids and pixels; false when the picture does not show the board.
bool find_points(ImageView8 grey, const Board& board, BoardView& view) {
  if (board.kind == BoardKind::kCharuco) {
    CharucoSeen seen = find_charuco(grey, board);
    if (static_cast<int>(seen.ids.size()) < kLeastCorners) return false;
    view.ids = std::move(seen.ids);
    view.pixels = std::move(seen.pixels);
    return true;
  }
  auto grid = find_grid(grey, board);
  if (!grid || !order_like_board(grey, board, *grid)) return false;
  view.pixels = std::move(grid->pixels);
  view.ids.resize(view.pixels.size());
  std::iota(view.ids.begin(), view.ids.end(), 0);
  return true;
}

/// Whether the board shows in a picture of half, a quarter or an eighth of the size, where blur is
/// smaller; then how wide its edges are in the full one [px].
double blur_that_hides(ImageView8 grey, const Board& board, int image_width) {
  Image8 small = half_size(grey);
  for (double scale = 2; scale <= 8; scale *= 2) {
    BoardView view;
    view.image_width = image_width;
    if (small.rows < 50 || small.cols < 50) return 0;
    if (find_points(small.view(), board, view)) {
      for (auto& p : view.pixels) p = scale * p + Eigen::Vector2d::Constant((scale - 1) / 2);
      return edge_width(grey, board, view);
    }
    small = half_size(small.view());
  }
  return 0;
}

struct Levels {
  double clipped_share = 0;  ///< [0..1]
  int bright = 0;            ///< 99th percentile [DN]
  int dark = 0;              ///< 1st percentile [DN]
};

Levels levels_of(ImageView8 grey) {
  std::array<std::size_t, 256> histogram{};
  for (int r = 0; r < grey.rows; ++r) {
    for (int c = 0; c < grey.cols; ++c) ++histogram[grey.row(r)[c]];
  }
  const double all = static_cast<double>(grey.rows) * grey.cols;
  Levels levels{static_cast<double>(histogram[255]) / all, 255, 0};
  for (double above = 0; levels.bright > 0; --levels.bright) {
    above += static_cast<double>(histogram[static_cast<std::size_t>(levels.bright)]);
    if (above > 0.01 * all) break;
  }
  for (double below = 0; levels.dark < 255; ++levels.dark) {
    below += static_cast<double>(histogram[static_cast<std::size_t>(levels.dark)]);
    if (below > 0.01 * all) break;
  }
  return levels;
}

bool shows_mirrored(ImageView8 grey, const Board& board) {
  const Image8 flipped = mirrored(grey);
  if (board.kind == BoardKind::kCharuco) {
    return static_cast<int>(find_charuco(flipped.view(), board).ids.size()) >= kLeastCorners;
  }
  if (board.kind != BoardKind::kAsymmetricCircles) return false;
  auto grid = find_grid(flipped.view(), board);
  return grid && order_like_board(flipped.view(), board, *grid);
}

std::string other_grid(ImageView8 grey, const Board& board) {
  const bool squares = board.kind == BoardKind::kChessboard;
  const auto other = squares ? find_any_chessboard(grey) : find_any_circle_grid(grey, board);
  if (!other) return {};
  if (std::max(other->cols, other->rows) == std::max(board.cols, board.rows) &&
      std::min(other->cols, other->rows) == std::min(board.cols, board.rows)) {
    return squares ? std::string()
                   : clause("the board has ",
                            other->cols,
                            " columns and ",
                            other->rows,
                            " rows, not ",
                            board.cols,
                            " and ",
                            board.rows,
                            "; exchange them");
  }
  // Which way round a stranger's rows run is open: say it as the board is said.
  const bool turn = (other->cols > other->rows) != (board.cols > board.rows);
  return clause(turn ? other->rows : other->cols,
                " x ",
                turn ? other->cols : other->rows,
                " points instead of ",
                board.cols,
                " x ",
                board.rows,
                ": part of the board is hidden or out of the picture, or its size is another");
}

/// Why the board was not found, the most certain reason first.
std::string reason(ImageView8 grey, const Board& board) {
  const Levels levels = levels_of(grey);
  if (shows_mirrored(grey, board)) return "mirrored; turn off the camera's mirror image";
  if (board.kind == BoardKind::kCharuco) {
    const CharucoSeen seen = find_charuco(grey, board);
    if (seen.markers > 0) {
      return clause("too few corners: ",
                    seen.ids.size(),
                    " of ",
                    board.size(),
                    " seen beside ",
                    seen.markers,
                    " markers, ",
                    kLeastCorners,
                    " are needed; show more of the board, and check dictionary, columns and rows");
    }
  }
  const double blur = blur_that_hides(grey, board, grey.cols);
  if (blur > 0) return clause("blurred: edges ", blur, " px wide; focus, or hold the board still");
  if (levels.clipped_share > 0.4) {
    return clause(
        "clipped: ", 100 * levels.clipped_share, " % of the picture at 255; shorten the exposure");
  }
  if (levels.bright - levels.dark < 40) {
    return clause("no contrast: nearly all of the picture between ",
                  levels.dark,
                  " and ",
                  levels.bright,
                  " DN; more light or a longer exposure");
  }
  if (board.kind != BoardKind::kCharuco) {
    std::string other = other_grid(grey, board);
    if (!other.empty()) return other;
  }
  return clause("nothing like '",
                to_string(board.kind),
                "' of ",
                board.cols,
                " x ",
                board.rows,
                " points; show it whole, flat and with its white border");
}

double pixels_per_pitch(const Board& board, const BoardView& view) {
  const Eigen::Vector3d across = board.point(view.ids.back()) - board.point(view.ids.front());
  return (view.pixels.back() - view.pixels.front()).norm() / (across.norm() / board.pitch());
}

}  // namespace

BoardView find_board(ImageView8 image, const Board& board, const std::string& name) {
  board.check();
  require(!image.empty(), "picture '", name, "' is empty; give one that shows the board");
  BoardView view;
  view.name = name;
  view.image_width = image.cols;
  view.image_height = image.rows;
  const std::vector<Image8> channels = channels_of(image);
  const auto shown = std::find_if(channels.begin(), channels.end(), [&](const Image8& grey) {
    return find_points(grey.view(), board, view);
  });
  if (shown == channels.end()) {
    view.failure = reason(channels.front().view(), board);
    return view;
  }
  view.sharpness = edge_width(shown->view(), board, view);
  view.clipped_share = clipped_share(channels.front().view(), view);
  if (view.sharpness > 0.35 * pixels_per_pitch(board, view)) {
    view.failure = clause("blurred: edges ",
                          view.sharpness,
                          " px wide where the points lie ",
                          pixels_per_pitch(board, view),
                          " px apart; focus, or hold the board still");
    view.ids.clear();
    view.pixels.clear();
  }
  return view;
}

}  // namespace facula
