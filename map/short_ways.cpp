// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/map/short_ways.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

namespace facula {
namespace {

using Steps = std::uint16_t;
constexpr Steps kNotReached = std::numeric_limits<Steps>::max();

/// A search over the cells of a box, whose outermost layers are closed.
class StepSearch {
 public:
  StepSearch(const Clearance& clearance, const CellBox& box, const ShortWaysOptions& options)
      : box_(grown_by_walls(box)), open_(box_.cells(), 0) {
    const auto rows = static_cast<std::size_t>(box.size(1)) * static_cast<std::size_t>(box.size(2));
    const auto look = [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        const auto ny = static_cast<std::size_t>(box.size(1));
        CellKey cell = {box.low[0],
                        box.low[1] + static_cast<int>(row % ny),
                        box.low[2] + static_cast<int>(row / ny)};
        std::uint8_t* line = open_.data() + box_.index(cell);
        for (; cell[0] <= box.high[0]; ++cell[0]) {
          *line++ = clearance.holds_at_centre(cell, options.radius) ? 1 : 0;
        }
      }
    };
    parallel_for(rows, look, {.num_threads = options.num_threads, .chunk = 64});
  }

  /// Opens the cells about one that may hold the ball somewhere.
  void open_around(const Clearance& clearance,
                   const CellBox& box,
                   const CellKey& end,
                   double radius) {
    const auto near = common_cells(box, grown({end, end}, 1));
    if (!near) return;
    CellKey cell{};
    for (cell[2] = near->low[2]; cell[2] <= near->high[2]; ++cell[2]) {
      for (cell[1] = near->low[1]; cell[1] <= near->high[1]; ++cell[1]) {
        for (cell[0] = near->low[0]; cell[0] <= near->high[0]; ++cell[0]) {
          if (clearance.may_hold(cell, radius)) open_[box_.index(cell)] = 1;
        }
      }
    }
  }

  /// Steps to every cell that is reached over cells for which useful(place, steps) holds.
  template <typename Useful>
  std::vector<Steps> steps_from(const CellKey& first, const Useful& useful) const {
    std::vector<Steps> steps(open_.size(), kNotReached);
    std::vector<std::uint32_t> front;
    std::vector<std::uint32_t> next;
    const auto nx = static_cast<std::ptrdiff_t>(box_.size(0));
    const std::ptrdiff_t layer = nx * box_.size(1);
    const std::array<std::ptrdiff_t, 6> ways = {-1, 1, -nx, nx, -layer, layer};
    const std::size_t start = box_.index(first);
    if (open_[start] == 0) return steps;
    steps[start] = 0;
    front.push_back(static_cast<std::uint32_t>(start));
    for (Steps step = 1; !front.empty() && step < kNotReached; ++step) {
      next.clear();
      for (const std::uint32_t place : front) {
        for (const std::ptrdiff_t way : ways) {
          const auto there = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(place) + way);
          if (open_[there] == 0 || steps[there] != kNotReached || !useful(there, step)) continue;
          steps[there] = step;
          next.push_back(static_cast<std::uint32_t>(there));
        }
      }
      std::swap(front, next);
    }
    return steps;
  }

  struct Reached {
    std::vector<Steps> steps;  // from the start, for all cells of ways that are short enough
    std::size_t longest = 0;   // such a way
  };

  /// Steps between the ends; none when they do not hang together. Cells from where even the
  /// straight way makes a longer one are left out, with a bound that grows until the goal is
  /// reached.
  std::optional<Reached> steps_to(const std::array<CellKey, 2>& ends, double detour) const {
    const auto with_detour = [&](std::size_t steps) {
      return steps + static_cast<std::size_t>(detour * static_cast<double>(steps));
    };
    const std::size_t goal = box_.index(ends[1]);
    for (std::size_t bound = with_detour(steps_between(ends[0], ends[1]));;) {
      bool pruned = false;
      std::optional<std::size_t> longest;
      auto steps = steps_from(ends[0], [&](std::size_t place, std::size_t step) {
        if (place == goal) longest = with_detour(step);
        const std::size_t most = longest ? std::min(*longest, bound) : bound;
        const bool fine = step + steps_between(cell_at(place), ends[1]) <= most;
        pruned = pruned || !fine;
        return fine;
      });
      if (goal == box_.index(ends[0])) longest = 0;
      if (longest && *longest <= bound) return Reached{std::move(steps), *longest};
      if (!longest && (!pruned || bound >= kNotReached)) return std::nullopt;
      bound = longest ? *longest : 2 * bound + 1;
    }
  }

  CellKey cell_at(std::size_t place) const {
    const auto nx = static_cast<std::uint32_t>(box_.size(0));
    const auto ny = static_cast<std::uint32_t>(box_.size(1));
    const auto number = static_cast<std::uint32_t>(place);
    return {box_.low[0] + static_cast<int>(number % nx),
            box_.low[1] + static_cast<int>(number / nx % ny),
            box_.low[2] + static_cast<int>(number / nx / ny)};
  }

 private:
  /// Where nothing is in the way.
  static std::size_t steps_between(const CellKey& a, const CellKey& b) {
    return static_cast<std::size_t>(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) +
                                    std::abs(a[2] - b[2]));
  }

  /// With a layer around it, outside of which no step can lead; keys may then lie outside of space.
  static CellBox grown_by_walls(const CellBox& box) {
    CellBox result = box;
    for (std::size_t i = 0; i < 3; ++i) {
      --result.low[i];
      ++result.high[i];
    }
    return result;
  }

  CellBox box_;
  std::vector<std::uint8_t> open_;
};

}  // namespace

std::vector<CellKey> cells_of_short_ways(const Clearance& clearance,
                                         const CellBox& box,
                                         const std::array<CellKey, 2>& ends,
                                         const ShortWaysOptions& options) {
  // Places are counted in 32 bits.
  if (box.cells() > std::numeric_limits<std::uint32_t>::max() / 2) return {};
  StepSearch search(clearance, box, options);
  for (const CellKey& end : ends) search.open_around(clearance, box, end, options.radius);
  const auto from_start = search.steps_to(ends, options.detour);
  if (!from_start) return {};
  const auto from_goal = search.steps_from(ends[1], [&](std::size_t place, std::size_t step) {
    return from_start->steps[place] != kNotReached &&
           from_start->steps[place] + step <= from_start->longest;
  });
  std::vector<CellKey> cells;
  for (std::size_t place = 0; place < from_goal.size(); ++place) {
    if (from_goal[place] != kNotReached) cells.push_back(search.cell_at(place));
  }
  return cells;
}

}  // namespace facula
