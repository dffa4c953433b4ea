// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/scan_list.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <algorithm>

namespace facula {

ScanStand ScanProject::stand() const {
  if (scans.empty()) return ScanStand::kFree;
  const ScanStand first = scans.front().stand;
  const bool same = std::all_of(
      scans.begin(), scans.end(), [first](const PosedCloud& scan) { return scan.stand == first; });
  return same ? first : ScanStand::kFree;
}

PointCloud ScanProject::fused() const {
  PointCloud all;
  for (const PosedCloud& scan : scans) {
    const PointCloud moved = transformed(scan.cloud, scan.world_from_scan);
    if (all.empty()) {
      all = moved;  // append() would drop the attributes that an empty cloud lacks
    } else {
      append(all, moved);
    }
  }
  return all;
}

ScanProject read_scan_project(const std::filesystem::path& path) {
  ScanProject project;
  for (const ListedScan& scan : list_scans(path)) project.scans.push_back(scan.read());
  return project;
}

}  // namespace facula
