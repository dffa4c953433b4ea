// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/board_detection.hpp>

namespace facula {

/// Puts the points of a whole grid into the board's order: rows and columns right-handed as seen
/// from the front; of the turns the board's print leaves open, the one whose first square is black,
/// and of those that are left, the one whose rows run most nearly to the right. Returns false when
/// the grid can only be a mirrored picture.
bool order_like_board(ImageView8 grey, const Board& board, GridSeen& grid);

}  // namespace facula
