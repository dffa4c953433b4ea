// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/filter_verdict.hpp>

namespace facula {

const char* to_string(Removal reason) {
  constexpr std::array<const char*, kRemovals> kNames{
      "kept", "not_finite", "mixed", "range", "incidence", "statistical", "radius"};
  return kNames[static_cast<std::size_t>(reason)];
}

FilterVerdict::FilterVerdict(std::size_t points) : reason(points, Removal::kKept) {
  count_of[0] = points;
}

void FilterVerdict::remove(std::size_t point, Removal why) {
  if (reason[point] != Removal::kKept || why == Removal::kKept) return;
  reason[point] = why;
  --count_of[0];
  ++count_of[static_cast<std::size_t>(why)];
}

std::vector<std::size_t> FilterVerdict::kept() const {
  std::vector<std::size_t> indices;
  indices.reserve(count(Removal::kKept));
  for (std::size_t i = 0; i < reason.size(); ++i) {
    if (reason[i] == Removal::kKept) indices.push_back(i);
  }
  return indices;
}

void add_verdict(FilterVerdict& verdict, const FilterVerdict& next) {
  require(verdict.count(Removal::kKept) == next.reason.size(),
          "a verdict on ",
          next.reason.size(),
          " points cannot follow one that keeps ",
          verdict.count(Removal::kKept));
  std::size_t i = 0;
  for (std::size_t point = 0; point < verdict.reason.size(); ++point) {
    if (verdict.reason[point] == Removal::kKept) verdict.remove(point, next.reason[i++]);
  }
}

void clear_removed(PolarScan& scan, const FilterVerdict& verdict) {
  require(scan.valid_count() == verdict.reason.size(),
          "a verdict on ",
          verdict.reason.size(),
          " points cannot clear cells of a scan of ",
          scan.valid_count());
  std::size_t point = 0;
  for (std::size_t cell = 0; cell < scan.valid.size(); ++cell) {
    if (scan.valid[cell] == 0) continue;
    if (verdict.reason[point++] != Removal::kKept) scan.clear(cell);
  }
}

void apply(GriddedCloud& scan, const FilterVerdict& verdict) {
  if (verdict.removed() == 0) return;
  const std::vector<std::size_t> kept = verdict.kept();
  scan.cloud = selected(scan.cloud, kept);
  if (!scan.grid.empty()) scan.grid = selected(scan.grid, kept);
}

}  // namespace facula
