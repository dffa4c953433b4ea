// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/map/cell_key.hpp>

#include <cstddef>
#include <deque>
#include <map>

namespace facula {

/// Steps through faces from one cell to all that hang together with it over cells for which
/// open(cell) holds, cell after cell by a queue: what faster searches have to find. Empty when the
/// first one is not open.
template <typename Open>
std::map<CellKey, int> steps_by_queue(const CellKey& first, const Open& open) {
  if (!open(first)) return {};
  std::map<CellKey, int> steps = {{first, 0}};
  std::deque<CellKey> queue = {first};
  while (!queue.empty()) {
    const CellKey cell = queue.front();
    queue.pop_front();
    for (std::size_t i = 0; i < 3; ++i) {
      for (const int step : {-1, 1}) {
        CellKey next = cell;
        next[i] += step;
        if (!open(next) || steps.contains(next)) continue;
        steps[next] = steps[cell] + 1;
        queue.push_back(next);
      }
    }
  }
  return steps;
}

}  // namespace facula
