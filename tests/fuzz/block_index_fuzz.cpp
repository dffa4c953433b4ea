// SPDX-License-Identifier: GPL-3.0-or-later
// The index of a map in blocks that holds any lines at all, under a right checksum: an Error, or an
// index whose text gives the same index again. An input that begins with 'f' is taken for a whole
// file as it is.
#include <facula/acquire/core/error.hpp>
#include <facula/map/block_index.hpp>
#include <facula/map/deflated.hpp>

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

using namespace facula;

std::string sealed(const std::string& lines) {
  std::string text = std::string(kBlockIndexMark) + "\n" + lines;
  if (!text.ends_with('\n')) text += '\n';
  std::array<char, 16> sum{};
  std::snprintf(sum.data(), sum.size(), "%08x", checksum(bytes_of_text(text)));
  return text + "checksum " + sum.data() + "\n";
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string input(data, data + size);
  try {
    const BlockIndex index =
        parse_block_index(input.starts_with('f') ? input : sealed(input), "fuzz");
    const BlockIndex again = parse_block_index(block_index_text(index), "fuzz");
    if (again.blocks != index.blocks || again.scans != index.scans) std::abort();
  } catch (const Error&) {
  }
  return 0;
}
