// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/scan_grid.hpp>

#include <algorithm>

namespace facula {

void ScanGrid::check(std::size_t points) const {
  require(rows >= 0 && cols >= 0 &&
              point.size() == static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols),
          "a scan grid of ",
          rows,
          " x ",
          cols,
          " cells holds ",
          point.size(),
          " entries; one per cell is needed");
  std::vector<bool> taken(points, false);
  for (const std::int32_t p : point) {
    if (p == kNone) continue;
    require(p >= 0 && static_cast<std::size_t>(p) < points && !taken[static_cast<std::size_t>(p)],
            "a scan grid names point ",
            p,
            " of ",
            points,
            ", which is not there or stands in another cell too");
    taken[static_cast<std::size_t>(p)] = true;
  }
}

ScanGrid grid_from_scan(const PolarScan& scan) {
  scan.check();
  ScanGrid grid{scan.rows, scan.cols, std::vector<std::int32_t>(scan.valid.size())};
  std::int32_t next = 0;
  std::transform(
      scan.valid.begin(), scan.valid.end(), grid.point.begin(), [&next](std::uint8_t valid) {
        return valid != 0 ? next++ : ScanGrid::kNone;
      });
  return grid;
}

ScanGrid selected(const ScanGrid& grid, const std::vector<std::size_t>& kept) {
  std::size_t points = 0;
  for (const std::int32_t p : grid.point) {
    points = std::max(points, static_cast<std::size_t>(p + 1));
  }
  std::vector<std::int32_t> renamed(points, ScanGrid::kNone);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] < points) renamed[kept[i]] = static_cast<std::int32_t>(i);
  }
  ScanGrid result = grid;
  for (std::int32_t& p : result.point) {
    if (p != ScanGrid::kNone) p = renamed[static_cast<std::size_t>(p)];
  }
  return result;
}

}  // namespace facula
