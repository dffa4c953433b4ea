// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/stripe_path.hpp>

#include <algorithm>

namespace facula {
namespace {

/// The best path that ends at a place, and the place it came from.
struct PathEnd {
  double worth = 0;
  int from_row = -1;
  int from_place = -1;
};

using PathEnds = std::vector<std::vector<PathEnd>>;

void check(const PathPrices& prices) {
  require(prices.step > 0 && prices.jump > 0 && prices.gap_row >= 0 && prices.reach > 0,
          "path prices: expected a step, a jump and a reach above 0 and a gap price of 0 or more");
}

double price_of_step(const PathPrices& prices, double sideways, std::size_t rows) {
  const double steps = sideways / prices.step;
  const double n = static_cast<double>(rows);
  return std::min(prices.jump, steps * steps / n + prices.gap_row * (n - 1));
}

/// Keeps the better of the ways into a place.
void offer(PathEnd& end, double worth, std::size_t row, std::size_t place) {
  if (!(worth > end.worth)) return;
  end = {worth, static_cast<int>(row), static_cast<int>(place)};
}

/// The best path among those that end in rows before `row`, to start a new piece from.
struct BestEnd {
  double worth = 0;
  std::size_t row = 0;
  std::size_t place = 0;
  bool any = false;

  void see(const std::vector<PathEnd>& ends, std::size_t in_row) {
    for (std::size_t k = 0; k < ends.size(); ++k) {
      if (any && !(ends[k].worth > worth)) continue;
      *this = {ends[k].worth, in_row, k, true};
    }
  }
};

std::vector<int> trace_back(const PathEnds& ends, const BestEnd& best) {
  std::vector<int> path(ends.size(), -1);
  if (!best.any || !(best.worth > 0)) return path;
  int row = static_cast<int>(best.row);
  int place = static_cast<int>(best.place);
  while (row >= 0) {
    path[static_cast<std::size_t>(row)] = place;
    const PathEnd& end = ends[static_cast<std::size_t>(row)][static_cast<std::size_t>(place)];
    row = end.from_row;
    place = end.from_place;
  }
  return path;
}

}  // namespace

std::vector<int> best_path(const std::vector<std::vector<PathPlace>>& rows,
                           const PathPrices& prices) {
  check(prices);
  PathEnds ends(rows.size());
  BestEnd best;  // over the rows before the current one
  for (std::size_t r = 0; r < rows.size(); ++r) {
    ends[r].resize(rows[r].size());
    for (std::size_t k = 0; k < rows[r].size(); ++k) {
      PathEnd& end = ends[r][k];
      if (best.any) offer(end, best.worth - prices.jump, best.row, best.place);
      for (std::size_t n = 1; n <= std::min(r, prices.reach); ++n) {
        for (std::size_t j = 0; j < rows[r - n].size(); ++j) {
          const double sideways = rows[r][k].position - rows[r - n][j].position;
          offer(end, ends[r - n][j].worth - price_of_step(prices, sideways, n), r - n, j);
        }
      }
      end.worth += rows[r][k].gain;
    }
    best.see(ends[r], r);
  }
  return trace_back(ends, best);
}

}  // namespace facula
