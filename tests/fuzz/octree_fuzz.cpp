// SPDX-License-Identifier: GPL-3.0-or-later
// Any bytes at all as an OctoMap file: an Error or a map that is written and read back unchanged.
#include <facula/acquire/core/error.hpp>
#include <facula/map/octree_file.hpp>

#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string_view>

namespace {

/// So that a hundred bytes that declare all of space to be free do not fill the memory.
constexpr std::size_t kMaxLeafBricks = 512;
constexpr facula::LogOddsModel kModel = {.hit = 0.85F, .miss = -0.4F, .min = -2, .max = 3.5F};

std::string written(const facula::OctreeContent& content) {
  std::ostringstream bytes;
  facula::write_ot(bytes, content.map, content.resolution);
  return bytes.str();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view file(reinterpret_cast<const char*>(data), size);
  try {
    const std::string once = written(facula::parse_octree(file, kModel, "fuzz", kMaxLeafBricks));
    if (written(facula::parse_octree(once, kModel, "fuzz")) != once) std::abort();
  } catch (const facula::Error&) {
  }
  return 0;
}
