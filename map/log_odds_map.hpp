// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/brick_index.hpp>
#include <facula/map/log_odds_brick.hpp>
#include <facula/map/scan_cells.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace facula {

/// Bricks of log-odds wherever something is known.
class LogOddsMap {
 public:
  struct Entry {
    std::uint64_t code;  ///< brick_code()
    LogOddsBrick brick;
  };

  /// Adds one scan; the same for any number of threads.
  void apply(std::span<const ScanBrick> scan, const LogOddsModel& model, int num_threads);

  /// Null where nothing is known.
  const LogOddsBrick* find(std::uint64_t code) const {
    const std::size_t place = index_.find(code);
    return place == BrickIndex::kNone ? nullptr : &entries_[place].brick;
  }
  LogOddsBrick& find_or_add(std::uint64_t code);
  void erase(std::uint64_t code);

  std::span<const Entry> entries() const { return entries_; }  ///< in the order of their making

  /// The entries in Morton order, which is the octree's.
  std::vector<const Entry*> sorted() const;

  std::size_t memory_usage() const;  ///< [bytes]

 private:
  std::vector<Entry> entries_;
  BrickIndex index_;
};

}  // namespace facula
