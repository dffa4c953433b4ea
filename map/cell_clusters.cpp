// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/disjoint_sets.hpp>
#include <facula/map/brick_index.hpp>
#include <facula/map/cell_clusters.hpp>

#include <cstdint>

namespace facula {
namespace {

std::uint64_t number_of(const CellKey& cell) {
  const auto part = [&](std::size_t i) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell[i])) << (17 * i);
  };
  return part(0) | part(1) | part(2);
}

}  // namespace

std::vector<std::size_t> cell_clusters(std::span<const CellKey> cells) {
  BrickIndex index;
  DisjointSets groups(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    bool added = false;
    index.find_or_add(number_of(cells[i]), i, &added);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (int step = 14; step < 27; ++step) {  // the thirteen neighbours that come later
      const CellKey near = {
          cells[i][0] + step % 3 - 1, cells[i][1] + step / 3 % 3 - 1, cells[i][2] + step / 9 - 1};
      if (near[0] < 0 || near[1] < 0) continue;
      const std::size_t found = index.find(number_of(near));
      if (found == BrickIndex::kNone) continue;
      groups.join(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(found));
    }
  }
  std::vector<std::size_t> numbers(cells.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t root = groups.find(static_cast<std::uint32_t>(i));
    numbers[i] = root == i ? count++ : numbers[root];
  }
  return numbers;
}

}  // namespace facula
