// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/map_mpi/rank_figures.hpp>
#include <facula/apps/map_mpi/ranks.hpp>
#include <facula/map/block_index.hpp>
#include <facula/map/log_odds_map.hpp>
#include <facula/map/occupancy_map.hpp>
#include <facula/reconstruct/register/scan_list.hpp>

#include <filesystem>
#include <vector>

namespace facula {

/// One rank's share of a map: the bricks of the blocks that are its own (owner_of_block()). All
/// shares together are, bit for bit, the map that one process makes by inserting the scans one by
/// one. Every rank calls the same functions in the same order.
class RankMap {
 public:
  RankMap(const Ranks& ranks, const OccupancyOptions& options);

  /// Deals the scans out in rounds: in round k rank r opens and casts scan k * size + r alone.
  /// After that every rank hands every other the bricks that are its own, once, and applies what it
  /// got in the order of the scans. Throws StepFailed where a scan cannot be read.
  void insert(const std::vector<ListedScan>& scans);

  /// Writes the share's blocks into a folder and forgets them. Throws as write_block() does.
  std::vector<BlockRecord> write(const std::filesystem::path& folder);

  const RankFigures& figures() const { return figures_; }

 private:
  std::vector<Bytes> cast(const ListedScan& listed);
  void apply(const std::vector<Bytes>& received);
  void count_cells();

  const Ranks& ranks_;
  OccupancyOptions options_;
  LogOddsMap share_;
  RankFigures figures_;
};

}  // namespace facula
