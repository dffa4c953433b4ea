// SPDX-License-Identifier: GPL-3.0-or-later
// A Facula map file whose blocks hold any bytes at all, under right checksums: an Error, or a map
// and scans that can be used, and taken out. The input is a row of blocks: one byte that says which
// kind, two for the size of the contents, the contents. An input that begins with 'F' is taken for
// a whole file as it is.
#include <facula/acquire/core/error.hpp>
#include <facula/map/deflated.hpp>
#include <facula/map/map_blocks.hpp>
#include <facula/map/map_file.hpp>

#include <array>
#include <cstdint>
#include <sstream>
#include <utility>

namespace {

using namespace facula;

constexpr std::array<MapBlockKind, 7> kKinds = {MapBlockKind::kOptions,
                                                MapBlockKind::kBricks,
                                                MapBlockKind::kScan,
                                                MapBlockKind::kCells,
                                                MapBlockKind::kEnd,
                                                MapBlockKind::kColors,
                                                MapBlockKind::kScanColors};

std::string sealed(ByteView input) {
  std::ostringstream file;
  write_map_start(file);
  while (input.size() >= 3) {
    const std::size_t size = std::min<std::size_t>(input[1] | input[2] << 8, input.size() - 3);
    const Bytes stored = deflated(input.subspan(3, size));
    write_map_block(file,
                    {kKinds[input[0] % kKinds.size()], static_cast<std::uint32_t>(size), stored});
    input = input.subspan(3 + size);
  }
  return file.str();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const ByteView input(data, size);
  const std::string file =
      size > 0 && data[0] == 'F' ? std::string(data, data + size) : sealed(input);
  try {
    MapFile content = parse_map_file(bytes_of_text(file), "fuzz");
    std::size_t cells = content.map.statistics().free_cells;
    for (const KeptScan& scan : content.scans) {
      cells += unpack(scan.cells).bricks.size() + unpack_colors(scan.colors).size();
    }
    if (!content.scans.empty()) {
      const std::string name = content.scans.front().record.name;
      ScanMap scans(std::move(content.map), std::move(content.scans));
      cells += scans.remove(name).bricks;
    }
    volatile std::size_t used = cells;
    static_cast<void>(used);
  } catch (const Error&) {
  }
  return 0;
}
