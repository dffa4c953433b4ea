// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/brick_box.hpp>
#include <facula/map/map_query.hpp>

#include <algorithm>
#include <array>

namespace facula {
namespace {

/// A table may have so many places per brick, and this many in any case.
constexpr std::size_t kPlacesPerBrick = 64;
constexpr std::size_t kPlacesAtLeast = 4096;

/// The cells of the brick that begins at `first` and lie in the box.
CellMask cells_in(const CellBox& box, const CellKey& first) {
  std::array<int, 3> begin{};
  std::array<int, 3> end{};
  for (std::size_t i = 0; i < 3; ++i) {
    begin[i] = std::max(box.low[i] - first[i], 0);
    end[i] = std::min(box.high[i] - first[i] + 1, kBrickEdge);
    if (begin[i] >= end[i]) return {};
  }
  const std::uint64_t row = (std::uint64_t{0xff} >> (kBrickEdge - (end[0] - begin[0]))) << begin[0];
  CellMask mask;
  for (int z = begin[2]; z < end[2]; ++z) {
    for (int y = begin[1]; y < end[1]; ++y)
      mask.words[static_cast<std::size_t>(z)] |= row << (8 * y);
  }
  return mask;
}

/// cell_of() without branches; false, and some cell, where that has none.
bool quick_cell_of(const Eigen::Vector3d& x, double cells_per_metre, CellKey& cell) {
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const double at = cells_per_metre * x[static_cast<Eigen::Index>(i)];
    const bool fits = (at >= -kCentreKey) & (at < kCentreKey);  // neither for NaN
    const double number = fits ? at : 0;
    const int truncated = static_cast<int>(number);
    cell[i] = truncated - static_cast<int>(truncated > number) + kCentreKey;
    inside = inside & fits;
  }
  return inside;
}

}  // namespace

MapQuery::MapQuery(const OccupancyMap& map, int num_threads)
    : resolution_(map.resolution()), known_(known_box(map)) {
  const auto entries = map.bricks().entries();
  bricks_.resize(entries.size() + 1);
  const auto copy = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      bricks_[i + 1] = {entries[i].brick.known(), entries[i].brick.occupied()};
    }
  };
  parallel_for(entries.size(), copy, {.num_threads = num_threads, .chunk = 1024});
  if (!known_) return;
  table_box_ = bricks_of(*known_);
  const std::size_t places = table_box_.cells();
  const bool dense = places <= std::max(kPlacesAtLeast, kPlacesPerBrick * bricks_.size());
  if (dense) table_.assign(places + 1, 0);
  for (std::size_t i = 1; i < bricks_.size(); ++i) {
    if (bricks_[i].known.none()) continue;
    const std::uint64_t code = entries[i - 1].code;
    if (dense) {
      table_[table_box_.index(brick_of(first_cell(code))) + 1] = static_cast<std::uint32_t>(i);
    } else {
      bool added = false;
      index_.find_or_add(code, i, &added);
    }
  }
}

/// A table without branches: questions about random places would mispredict them.
const MapQuery::Brick& MapQuery::find(const CellKey& cell) const {
  if (table_.empty()) {
    const std::size_t place = index_.find(brick_code(cell));
    return bricks_[place == BrickIndex::kNone ? 0 : place];
  }
  std::size_t place = 0;
  std::size_t stride = 1;
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto along = static_cast<std::uint32_t>(cell[i] / kBrickEdge - table_box_.low[i]);
    const auto size = static_cast<std::uint32_t>(table_box_.size(i));
    inside = inside & (along < size);
    place += along * stride;
    stride *= size;
  }
  return bricks_[table_[inside ? place + 1 : 0]];
}

CellState MapQuery::state_of_cell(const CellKey& cell) const {
  const Brick& brick = find(cell);
  const std::size_t place = cell_in_brick(cell);
  // Occupied cells are known, so that the sum of both bits is the state.
  static_assert(static_cast<int>(CellState::kUnknown) == 0 &&
                static_cast<int>(CellState::kFree) == 1 &&
                static_cast<int>(CellState::kOccupied) == 2);
  return static_cast<CellState>(static_cast<int>(brick.known.test(place)) +
                                static_cast<int>(brick.occupied.test(place)));
}

CellState MapQuery::state(const Eigen::Vector3d& x) const {
  const auto cell = cell_of(x, resolution_);
  return cell ? state_of_cell(*cell) : CellState::kUnknown;
}

std::vector<CellState> MapQuery::states(std::span<const Eigen::Vector3d> points,
                                        int num_threads) const {
  std::vector<CellState> states(points.size());
  const auto look = [&](std::size_t begin, std::size_t end) {
    const double cells_per_metre = 1.0 / resolution_;
    for (std::size_t i = begin; i < end; ++i) {
      CellKey cell{};
      const bool inside = quick_cell_of(points[i], cells_per_metre, cell);
      states[i] = inside ? state_of_cell(cell) : CellState::kUnknown;
    }
  };
  parallel_for(points.size(), look, {.num_threads = num_threads, .chunk = 8192});
  return states;
}

CellCounts MapQuery::count(const CellBox& box) const {
  CellCounts counts{.unknown = box.cells()};
  const auto inside = known_ ? common_cells(box, *known_) : std::nullopt;
  if (!inside) return counts;
  any_brick(bricks_of(*inside), [&](const CellKey& at) {
    const Brick& brick = find(first_of(at));
    const CellMask cells = cells_in(*inside, first_of(at));
    const auto known = static_cast<std::size_t>((brick.known & cells).count());
    const auto occupied = static_cast<std::size_t>((brick.occupied & cells).count());
    counts.occupied += occupied;
    counts.free += known - occupied;
    counts.unknown -= known;
    return false;
  });
  return counts;
}

bool MapQuery::any_occupied(const CellBox& box) const {
  const auto inside = known_ ? common_cells(box, *known_) : std::nullopt;
  return inside && any_brick(bricks_of(*inside), [&](const CellKey& at) {
           return !(find(first_of(at)).occupied & cells_in(*inside, first_of(at))).none();
         });
}

std::size_t MapQuery::memory_usage() const {
  return sizeof *this + bricks_.capacity() * sizeof(Brick) +
         table_.capacity() * sizeof(std::uint32_t) + index_.memory_usage();
}

}  // namespace facula
