// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_project.hpp>

#include <vector>

namespace facula {

/// Scans of hand-sized things that are not the bunny, seen along z every 0.5 mm with noise of
/// 0.1 mm: ball, can, board, box corner, vase; and a scan of a room, made as small as the bunny.
std::vector<PosedCloud> foreign_objects();

/// Scans of rooms that are not the furnished one, by the head, with noise of 1 mm: another hall,
/// the furnished room a quarter larger, and an empty room of exactly the furnished one's size.
std::vector<PosedCloud> foreign_rooms();

}  // namespace facula
