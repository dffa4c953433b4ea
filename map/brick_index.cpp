// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/brick_index.hpp>

#include <algorithm>
#include <utility>

namespace facula {

std::size_t BrickIndex::find_or_add(std::uint64_t code, std::size_t next, bool* added) {
  if (2 * (size_ + 1) > slots_.size()) grow();
  std::size_t slot = home(code);
  while (slots_[slot].code != kFree) {
    if (slots_[slot].code == code) return slots_[slot].place;
    slot = (slot + 1) & mask();
  }
  slots_[slot] = {code, static_cast<std::uint32_t>(next)};
  ++size_;
  *added = true;
  return next;
}

std::size_t BrickIndex::slot_of(std::uint64_t code) const {
  std::size_t slot = home(code);
  while (slots_[slot].code != code) slot = (slot + 1) & mask();
  return slot;
}

void BrickIndex::move(std::uint64_t code, std::size_t place) {
  slots_[slot_of(code)].place = static_cast<std::uint32_t>(place);
}

void BrickIndex::erase(std::uint64_t code) {
  // Whatever could no longer be found over the gap moves into it (Knuth, TAOCP 3, 6.4, algorithm
  // R).
  std::size_t gap = slot_of(code);
  for (std::size_t slot = (gap + 1) & mask(); slots_[slot].code != kFree;
       slot = (slot + 1) & mask()) {
    const std::size_t way = (slot - home(slots_[slot].code)) & mask();
    if (way < ((slot - gap) & mask())) continue;
    slots_[gap] = slots_[slot];
    gap = slot;
  }
  slots_[gap] = {};
  --size_;
}

void BrickIndex::clear() {
  slots_.clear();
  size_ = 0;
}

void BrickIndex::grow() {
  const std::vector<Slot> old =
      std::exchange(slots_, std::vector<Slot>(std::max<std::size_t>(256, 2 * slots_.size())));
  for (const Slot& entry : old) {
    if (entry.code == kFree) continue;
    std::size_t slot = home(entry.code);
    while (slots_[slot].code != kFree) slot = (slot + 1) & mask();
    slots_[slot] = entry;
  }
}

}  // namespace facula
