// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/brick_codes.hpp>
#include <facula/map/mask_bytes.hpp>
#include <facula/map/packed_map.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

namespace facula {
namespace {

using Numbers = std::array<std::uint16_t, kCellsPerBrick>;

/// The different values of a brick, as bits, and the number that each known cell's value has.
struct ValueTable {
  std::vector<std::uint32_t> values;
  Numbers numbers{};

  ValueTable(const LogOddsBrick::Values& cells, const CellMask& known) {
    for_each_cell(known, [&](std::size_t cell) {
      const auto bits = std::bit_cast<std::uint32_t>(cells[cell]);
      if (values.empty() || bits != values.back()) values.push_back(bits);
    });
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
    for_each_cell(known, [&](std::size_t cell) {
      const auto bits = std::bit_cast<std::uint32_t>(cells[cell]);
      const auto place = std::lower_bound(values.begin(), values.end(), bits);
      numbers[cell] = static_cast<std::uint16_t>(place - values.begin());
    });
  }
};

void put_numbers(Bytes& bytes, const ValueTable& table, const CellMask& known) {
  if (table.values.size() > LogOddsBrick::kFewValues) {
    for_each_cell(known, [&](std::size_t cell) { put(bytes, table.numbers[cell]); });
    return;
  }
  for (std::size_t bit = 0; (table.values.size() - 1) >> bit != 0; ++bit) {
    CellMask plane;
    for_each_cell(known, [&](std::size_t cell) {
      if ((table.numbers[cell] >> bit & 1) != 0) plane.set(cell);
    });
    put_mask(bytes, plane);
  }
}

Numbers take_numbers(ByteReader& reader, std::size_t count, const CellMask& known) {
  Numbers numbers{};
  if (count > LogOddsBrick::kFewValues) {
    for_each_cell(known, [&](std::size_t cell) { numbers[cell] = reader.take<std::uint16_t>(); });
    return numbers;
  }
  for (std::size_t bit = 0; (count - 1) >> bit != 0; ++bit) {
    for_each_cell(take_mask(reader), [&](std::size_t cell) {
      numbers[cell] = static_cast<std::uint16_t>(numbers[cell] | 1U << bit);
    });
  }
  return numbers;
}

void take_brick(ByteReader& reader, LogOddsBrick& brick) {
  const std::uint64_t count = take_varint(reader);
  require(count >= 1 && count <= kCellsPerBrick,
          "expected 1 to 512 different log-odds in a brick, got ",
          count);
  const CellMask known = take_mask(reader);
  require(!known.none(), "a brick has no known cell");
  LogOddsBrick::Values table{};
  for (std::size_t i = 0; i < count; ++i) {
    table[i] = reader.take<float>();
    require(std::isfinite(table[i]), "a log-odds value is not a number");
  }
  const Numbers numbers = take_numbers(reader, count, known);
  require(!reader.failed(), "a block ends within a brick");
  LogOddsBrick::Values values{};
  for_each_cell(known, [&](std::size_t cell) {
    require(numbers[cell] < count, "a cell has value ", numbers[cell], " of ", count);
    values[cell] = table[numbers[cell]];
  });
  brick.assign(values, known);
}

}  // namespace

Bytes map_bricks_bytes(std::span<const LogOddsMap::Entry* const> bricks) {
  Bytes bytes;
  bytes.reserve(128 * bricks.size());
  put_varint(bytes, bricks.size());
  BrickCodeWriter codes;
  for (const LogOddsMap::Entry* entry : bricks) {
    LogOddsBrick::Values cells{};
    const CellMask known = entry->brick.read(cells);
    const ValueTable table(cells, known);
    codes.put(bytes, entry->code);
    put_varint(bytes, table.values.size());
    put_mask(bytes, known);
    put_bytes(bytes, table.values.data(), table.values.size() * sizeof(std::uint32_t));
    put_numbers(bytes, table, known);
  }
  return bytes;
}

std::size_t parse_map_bricks(ByteView bytes, std::uint64_t& next, LogOddsMap& map) {
  ByteReader reader(bytes);
  const std::uint64_t count = take_varint(reader);
  require(count >= 1 && count <= kMapBricksPerBlock,
          "expected 1 to ",
          kMapBricksPerBlock,
          " bricks in a block, got ",
          count);
  BrickCodeReader codes;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t code = codes.take(reader);
    require(code >= next, "a brick stands twice, or not in the order of the octree");
    next = code + 1;
    take_brick(reader, map.find_or_add(code));
  }
  require(reader.left() == 0, "a block holds ", reader.left(), " bytes too many");
  return count;
}

}  // namespace facula
