// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/apps/commands/board_pictures.hpp>

#include <algorithm>

namespace facula {

void declare_board(Arguments& arguments, BoardArguments& a) {
  arguments.choice("--board",
                   a.kind,
                   {"chessboard", "circles", "asymmetric-circles", "charuco"},
                   "what is printed on the board");
  arguments.whole("--cols", a.board.cols, "inner corners or circles in a row");
  arguments.required();
  arguments.whole("--rows", a.board.rows, "rows of them");
  arguments.required();
  arguments.number("--spacing-mm",
                   a.board.spacing,
                   kMillimetres,
                   "between neighbours of a row (asymmetric circles: half of it), as measured");
  arguments.required();
  arguments.number("--circle-mm",
                   a.board.circle_diameter,
                   kMillimetres,
                   "diameter of the circles: takes out the bias of their centres, 0 = leave it in");
  arguments.number("--marker-mm",
                   a.board.marker_size,
                   kMillimetres,
                   "side of a ChArUco marker, 0 = 0.8 of the spacing");
  arguments.choice("--dictionary",
                   a.board.dictionary,
                   {"4x4_50",
                    "4x4_100",
                    "4x4_250",
                    "4x4_1000",
                    "5x5_50",
                    "5x5_100",
                    "5x5_250",
                    "5x5_1000",
                    "6x6_50",
                    "6x6_100",
                    "6x6_250",
                    "6x6_1000",
                    "7x7_50",
                    "7x7_100",
                    "7x7_250",
                    "7x7_1000"},
                   "of the ChArUco markers");
}

Board board_of(const BoardArguments& a) {
  Board board = a.board;
  board.kind = board_kind_from_name(a.kind);
  board.check();
  return board;
}

std::vector<BoardView> find_boards(const std::vector<std::filesystem::path>& pictures,
                                   const Board& board,
                                   Session& session) {
  std::vector<BoardView> views(pictures.size());
  parallel_for(pictures.size(),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   const Image8 picture = read_image(pictures[i]);
                   views[i] = find_board(picture.view(), board, pictures[i].filename().string());
                 }
               },
               {.num_threads = session.num_threads, .chunk = 1});
  return views;
}

void report_boards(const std::vector<BoardView>& views, Figures& figures) {
  const auto found =
      std::count_if(views.begin(), views.end(), [](const BoardView& view) { return view.found(); });
  figures.count("pictures", "pictures", views.size());
  figures.count("boards_found", "with the board", static_cast<std::size_t>(found));
}

}  // namespace facula
