// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// What one rank has done; travels as it lies in memory.
struct RankFigures {
  std::uint64_t scans = 0;           ///< cast [1]
  std::uint64_t points = 0;          ///< read [1]
  std::uint64_t coloured = 0;        ///< scans with colours, which are left out [1]
  std::uint64_t mixed_removed = 0;   ///< points between two surfaces [1]
  std::uint64_t rays = 0;            ///< cast, those skipped too [1]
  std::uint64_t skipped = 0;         ///< points not finite or outside space [1]
  std::uint64_t packed = 0;          ///< cells of its scans as they travel [bytes]
  std::uint64_t sent = 0;            ///< of those what went to other ranks [bytes]
  std::uint64_t bricks = 0;          ///< of its share of the map [1]
  std::uint64_t free_cells = 0;      ///< of its share [1]
  std::uint64_t occupied_cells = 0;  ///< of its share [1]
  std::uint64_t blocks = 0;          ///< files written [1]
  std::uint64_t file_bytes = 0;      ///< in them [bytes]
  std::uint64_t map_memory = 0;      ///< of its share [bytes]
  std::uint64_t peak_memory = 0;     ///< of the process since its start (VmHWM) [bytes]
  double reading = 0;                ///< of scans, mixed points included [s]
  double casting = 0;                ///< rays, and packing their cells [s]
  double waiting = 0;                ///< for the slowest rank of a round [s]
  double exchanging = 0;             ///< cells with the others [s]
  double applying = 0;               ///< scans to its share, unpacking them [s]
  double writing = 0;                ///< files of blocks [s]
};

/// Reports sums, maxima and a table of all ranks.
void report_ranks(const std::vector<RankFigures>& ranks, Figures& figures);

/// Most memory that this process ever had [bytes]; 0 where the system does not say.
std::uint64_t peak_memory();

}  // namespace facula
