// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/brick_index.hpp>
#include <facula/map/cell_clusters.hpp>

#include <algorithm>
#include <cstdint>
#include <numeric>

namespace facula {
namespace {

std::uint64_t number_of(const CellKey& cell) {
  const auto part = [&](std::size_t i) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(cell[i])) << (17 * i);
  };
  return part(0) | part(1) | part(2);
}

/// Groups by parent links, halved on the way up; the root is the first member.
class Groups {
 public:
  explicit Groups(std::size_t count) : parents_(count) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }

  std::size_t root(std::size_t i) {
    while (parents_[i] != i) {
      parents_[i] = parents_[parents_[i]];
      i = parents_[i];
    }
    return i;
  }

  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parents_;
};

}  // namespace

std::vector<std::size_t> cell_clusters(std::span<const CellKey> cells) {
  BrickIndex index;
  Groups groups(cells.size());
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
      if (found != BrickIndex::kNone) groups.join(i, found);
    }
  }
  std::vector<std::size_t> numbers(cells.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::size_t root = groups.root(i);
    numbers[i] = root == i ? count++ : numbers[root];
  }
  return numbers;
}

}  // namespace facula
