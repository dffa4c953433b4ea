// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/board.hpp>
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/cli/session.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace facula {

/// The options by which a user describes a board.
struct BoardArguments {
  std::string kind = "chessboard";
  Board board;
};
void declare_board(Arguments& arguments, BoardArguments& a);

/// The board that was described. Throws Error when it cannot be.
Board board_of(const BoardArguments& a);

/// Looks for the board in every picture, in the order given.
std::vector<BoardView> find_boards(const std::vector<std::filesystem::path>& pictures,
                                   const Board& board,
                                   Session& session);

/// Share of pictures with the board, and a note for each without it.
void report_boards(const std::vector<BoardView>& views, Figures& figures);

}  // namespace facula
