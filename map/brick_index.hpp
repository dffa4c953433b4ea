// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// From the code of a brick to its place in an array: a hash table with open addressing. Codes may
/// be any number below 2^64 - 1.
class BrickIndex {
 public:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Place of the code, or kNone.
  std::size_t find(std::uint64_t code) const {
    if (slots_.empty()) return kNone;
    for (std::size_t slot = home(code);; slot = (slot + 1) & mask()) {
      if (slots_[slot].code == code) return slots_[slot].place;
      if (slots_[slot].code == kFree) return kNone;
    }
  }

  /// Place of the code; when it is new, its place is `next`, and *added becomes true.
  std::size_t find_or_add(std::uint64_t code, std::size_t next, bool* added);

  /// Gives a code that is there another place.
  void move(std::uint64_t code, std::size_t place);

  void erase(std::uint64_t code);
  void clear();
  std::size_t size() const { return size_; }
  std::size_t memory_usage() const { return slots_.capacity() * sizeof(Slot); }  ///< [bytes]

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t code = kFree;
    std::uint32_t place = 0;
  };

  std::size_t mask() const { return slots_.size() - 1; }
  /// Fibonacci hashing (Knuth, TAOCP 3, 6.4) of the folded code.
  std::size_t home(std::uint64_t code) const {
    return static_cast<std::size_t>(((code ^ (code >> 32)) * 0x9e3779b97f4a7c15ULL) >> 32) & mask();
  }
  std::size_t slot_of(std::uint64_t code) const;
  void grow();

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

}  // namespace facula
