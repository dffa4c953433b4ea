// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/log_odds_map.hpp>

#include <algorithm>
#include <utility>

namespace facula {

void LogOddsMap::apply(std::span<const ScanBrick> scan,
                       const LogOddsModel& model,
                       int num_threads) {
  // What is said about one brick goes to one thread.
  std::vector<std::size_t> first;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    if (i > 0 && scan[i].code == scan[i - 1].code) continue;
    bool added = false;
    first.push_back(i);
    places.push_back(index_.find_or_add(scan[i].code, entries_.size(), &added));
    if (added) entries_.push_back({scan[i].code, {}});
  }
  first.push_back(scan.size());
  const auto update = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (const ScanBrick& seen : scan.subspan(first[i], first[i + 1] - first[i])) {
        const bool sure = seen.eighths == ScanBrick::kSure;
        entries_[places[i]].brick.apply(
            seen.passed, seen.ended, sure ? model : model.with_hit(seen.eighths));
      }
    }
  };
  parallel_for(places.size(), update, {.num_threads = num_threads, .chunk = 512});
}

LogOddsBrick& LogOddsMap::find_or_add(std::uint64_t code) {
  bool added = false;
  const std::size_t place = index_.find_or_add(code, entries_.size(), &added);
  if (added) entries_.push_back({code, {}});
  return entries_[place].brick;
}

void LogOddsMap::erase(std::uint64_t code) {
  const std::size_t place = index_.find(code);
  if (place == BrickIndex::kNone) return;
  index_.erase(code);
  if (place + 1 != entries_.size()) {
    entries_[place] = std::move(entries_.back());
    index_.move(entries_[place].code, place);
  }
  entries_.pop_back();
}

std::vector<const LogOddsMap::Entry*> LogOddsMap::sorted() const {
  std::vector<const Entry*> order;
  order.reserve(entries_.size());
  for (const Entry& entry : entries_) {
    if (!entry.brick.empty()) order.push_back(&entry);
  }
  std::sort(
      order.begin(), order.end(), [](const Entry* a, const Entry* b) { return a->code < b->code; });
  return order;
}

std::size_t LogOddsMap::memory_usage() const {
  std::size_t bytes = sizeof *this + entries_.capacity() * sizeof(Entry) + index_.memory_usage();
  for (const Entry& entry : entries_) bytes += entry.brick.memory_usage();
  return bytes;
}

}  // namespace facula
