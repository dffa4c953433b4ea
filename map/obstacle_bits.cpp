// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/obstacle_bits.hpp>

#include <algorithm>
#include <cstring>

namespace facula {
namespace {

std::size_t bytes_of_row(const CellBox& box) {
  const auto cells = static_cast<std::size_t>((box.low[0] & 7) + box.size(0));
  return (cells + 7) / 8 + sizeof(std::uint64_t);
}

/// The part of a brick's edge that lies in the box.
struct Span {
  int begin = 0;
  int end = 0;
};

Span clipped(const CellBox& box, std::size_t axis, int first) {
  return {std::max(0, box.low[axis] - first), std::min(kBrickEdge, box.high[axis] - first + 1)};
}

}  // namespace

ObstacleBits::ObstacleBits(const OccupancyMap& map,
                           const CellBox& box,
                           UnknownCells unknown,
                           int num_threads)
    : box_(box), skipped_(box.low[0] & 7), row_bytes_(bytes_of_row(box)) {
  const bool fill = unknown == UnknownCells::kOccupied;
  bytes_.assign(rows() * row_bytes_, fill ? 0xff : 0);
  const auto entries = map.bricks().entries();
  // Every brick has bytes of its own, so that threads never write the same one.
  const auto copy = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const CellKey first = first_cell(entries[i].code);
      const Span y = clipped(box_, 1, first[1]);
      const Span z = clipped(box_, 2, first[2]);
      const int column = (first[0] - (box_.low[0] - skipped_)) / kBrickEdge;
      if (y.begin >= y.end || z.begin >= z.end) continue;
      if (first[0] + kBrickEdge <= box_.low[0] || first[0] > box_.high[0]) continue;
      CellMask mask = entries[i].brick.occupied();
      if (fill) mask |= ~entries[i].brick.known();
      for (int k = z.begin; k < z.end; ++k) {
        for (int j = y.begin; j < y.end; ++j) {
          const auto row = static_cast<std::size_t>(first[2] + k - box_.low[2]) *
                               static_cast<std::size_t>(box_.size(1)) +
                           static_cast<std::size_t>(first[1] + j - box_.low[1]);
          bytes_[row * row_bytes_ + static_cast<std::size_t>(column)] =
              static_cast<std::uint8_t>(mask.words[static_cast<std::size_t>(k)] >> (8 * j));
        }
      }
    }
  };
  parallel_for(entries.size(), copy, {.num_threads = num_threads, .chunk = 1024});
}

std::uint64_t ObstacleBits::from(std::size_t row, int x) const {
  const auto bit = static_cast<std::size_t>(skipped_ + x);
  std::uint64_t word = 0;
  std::memcpy(&word, bytes_.data() + row * row_bytes_ + bit / 8, sizeof word);
  return word >> (bit % 8);
}

std::size_t ObstacleBits::rows() const {
  return static_cast<std::size_t>(box_.size(1)) * static_cast<std::size_t>(box_.size(2));
}

std::size_t ObstacleBits::memory_needed(const CellBox& box) {
  return bytes_of_row(box) * static_cast<std::size_t>(box.size(1)) *
         static_cast<std::size_t>(box.size(2));
}

}  // namespace facula
