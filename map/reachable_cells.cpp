// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/reachable_cells.hpp>

#include <algorithm>
#include <bit>
#include <span>

namespace facula {
namespace {

constexpr int kWordBits = 64;

/// Seeds and all that hangs together with them towards higher bits within `free`, in six doublings.
std::uint64_t spread_up(std::uint64_t seeds, std::uint64_t free) {
  for (int step = 1; step < kWordBits; step *= 2) {
    seeds |= free & (seeds << step);
    free &= free << step;
  }
  return seeds;
}

std::uint64_t spread_down(std::uint64_t seeds, std::uint64_t free) {
  for (int step = 1; step < kWordBits; step *= 2) {
    seeds |= free & (seeds >> step);
    free &= free >> step;
  }
  return seeds;
}

/// Spreads what is reached along a row; `reached` is a subset of `free`.
void spread_along(std::span<std::uint64_t> reached, std::span<const std::uint64_t> free) {
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    reached[i] = spread_up(reached[i] | (carry & free[i]), free[i]);
    carry = reached[i] >> (kWordBits - 1);
  }
  carry = 0;
  for (std::size_t i = reached.size(); i-- > 0;) {
    reached[i] = spread_down(reached[i] | ((carry << (kWordBits - 1)) & free[i]), free[i]);
    carry = reached[i] & 1;
  }
}

}  // namespace

ReachableCells::ReachableCells(const Clearance& clearance,
                               const CellBox& box,
                               const CellKey& first,
                               double radius,
                               int num_threads)
    : box_(box), words_(static_cast<std::size_t>(box.size(0) + kWordBits - 1) / kWordBits) {
  require(box.contains(first), "expected a first cell within the box of reachable cells");
  const auto rows = static_cast<std::size_t>(box.size(1)) * static_cast<std::size_t>(box.size(2));
  std::vector<std::uint64_t> passable(rows * words_, 0);
  const auto look = [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const auto ny = static_cast<std::size_t>(box_.size(1));
      CellKey cell = {
          0, box_.low[1] + static_cast<int>(row % ny), box_.low[2] + static_cast<int>(row / ny)};
      for (int x = 0; x < box_.size(0); ++x) {
        cell[0] = box_.low[0] + x;
        const auto bit = static_cast<std::uint64_t>(clearance.may_hold(cell, radius));
        passable[row * words_ + static_cast<std::size_t>(x / kWordBits)] |= bit << (x % kWordBits);
      }
    }
  };
  parallel_for(rows, look, {.num_threads = num_threads, .chunk = 64});
  cells_.assign(passable.size(), 0);
  const int x = first[0] - box_.low[0];
  const std::size_t word = row_of(first) * words_ + static_cast<std::size_t>(x / kWordBits);
  cells_[word] = passable[word] & (std::uint64_t{1} << (x % kWordBits));
  fill(passable);
  below_.reserve(cells_.size() + 1);
  below_.push_back(0);
  for (const std::uint64_t bits : cells_) {
    below_.push_back(below_.back() + static_cast<std::size_t>(std::popcount(bits)));
  }
}

std::size_t ReachableCells::row_of(const CellKey& cell) const {
  return static_cast<std::size_t>(cell[1] - box_.low[1]) +
         static_cast<std::size_t>(box_.size(1)) * static_cast<std::size_t>(cell[2] - box_.low[2]);
}

/// Takes over from the four neighbouring rows and spreads along the row; true when it grew.
bool ReachableCells::fill_row(const std::vector<std::uint64_t>& passable, std::size_t row) {
  const auto ny = static_cast<std::size_t>(box_.size(1));
  const std::size_t rows = passable.size() / words_;
  std::uint64_t grown = 0;
  const auto take = [&](std::size_t other) {
    for (std::size_t i = 0; i < words_; ++i) {
      std::uint64_t& ours = cells_[row * words_ + i];
      const std::uint64_t more = cells_[other * words_ + i] & passable[row * words_ + i] & ~ours;
      ours |= more;
      grown |= more;
    }
  };
  if (row % ny > 0) take(row - 1);
  if (row % ny + 1 < ny) take(row + 1);
  if (row >= ny) take(row - ny);
  if (row + ny < rows) take(row + ny);
  if (grown == 0) return false;
  spread_along({cells_.data() + row * words_, words_}, {passable.data() + row * words_, words_});
  return true;
}

/// Sweeps forth and back over the rows until none grows.
void ReachableCells::fill(const std::vector<std::uint64_t>& passable) {
  const std::size_t rows = passable.size() / words_;
  for (std::size_t row = 0; row < rows; ++row) {
    spread_along({cells_.data() + row * words_, words_}, {passable.data() + row * words_, words_});
  }
  for (bool grew = true; grew;) {
    grew = false;
    for (std::size_t row = 0; row < rows; ++row) grew = fill_row(passable, row) || grew;
    for (std::size_t row = rows; row-- > 0;) grew = fill_row(passable, row) || grew;
  }
}

bool ReachableCells::contains(const CellKey& cell) const {
  if (!box_.contains(cell)) return false;
  const int x = cell[0] - box_.low[0];
  const std::size_t word = row_of(cell) * words_ + static_cast<std::size_t>(x / kWordBits);
  return (cells_[word] >> (x % kWordBits) & 1) != 0;
}

CellKey ReachableCells::operator[](std::size_t number) const {
  const auto behind = std::upper_bound(below_.begin(), below_.end(), number);
  const auto word = static_cast<std::size_t>(behind - below_.begin()) - 1;
  std::uint64_t bits = cells_[word];
  for (std::size_t i = below_[word]; i < number; ++i) bits &= bits - 1;
  const std::size_t row = word / words_;
  const auto ny = static_cast<std::size_t>(box_.size(1));
  return {box_.low[0] + static_cast<int>(word % words_) * kWordBits + std::countr_zero(bits),
          box_.low[1] + static_cast<int>(row % ny),
          box_.low[2] + static_cast<int>(row / ny)};
}

}  // namespace facula
