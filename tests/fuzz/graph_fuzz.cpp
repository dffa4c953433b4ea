// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes at all as an OctoMap log of scans: an Error or scans that are no more than the bytes.
#include <facula/acquire/core/error.hpp>
#include <facula/map/scan_graph.hpp>

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const facula::ScanGraph graph = facula::parse_scan_graph({data, size}, "fuzz");
    if (28 * graph.points() > size) std::abort();  // a point takes 28 bytes
    for (const facula::GraphScan& scan : graph.scans) {
      if (facula::world_cloud(scan).size() != scan.points.size()) std::abort();
    }
  } catch (const facula::Error&) {
  }
  return 0;
}
