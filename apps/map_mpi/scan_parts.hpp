// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/byte_sequence.hpp>
#include <facula/map/scan_cells.hpp>

#include <cstddef>
#include <vector>

namespace facula {

/// A scan's bricks as they travel: part i is for owner i (owner_of_block()), empty where it gets
/// none. A part is a row of blocks: a size (32 bits) and as many scan_bricks_bytes(). The same for
/// any number of threads.
std::vector<Bytes> parts_of_scan(const ScanCells& scan, std::size_t owners, int num_threads);

/// A part opened: bricks in the order of the scan. Throws Error unless the bytes are such a part.
std::vector<ScanBrick> bricks_of_part(ByteView part, int num_threads);

}  // namespace facula
