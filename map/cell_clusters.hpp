// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_key.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace facula {

/// Numbers the cells by the groups that hang together over faces, edges or corners (26 neighbours).
/// Groups are numbered from 0 in the order of their first cells. No cell may be there twice.
std::vector<std::size_t> cell_clusters(std::span<const CellKey> cells);

}  // namespace facula
