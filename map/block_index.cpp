// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/map/block_index.hpp>
#include <facula/map/deflated.hpp>
#include <facula/map/space_block.hpp>

#include <array>
#include <utility>

namespace facula {
namespace {

/// What the first line says but for the version.
const std::string_view kMarkOfAll = kBlockIndexMark.substr(0, kBlockIndexMark.size() - 1);
constexpr std::string_view kChecksum = "checksum ";

std::string hex_text(std::uint32_t value) {
  std::array<char, 8> digits{};
  for (std::size_t i = 0; i < digits.size(); ++i) {
    digits[digits.size() - 1 - i] = "0123456789abcdef"[value >> (4 * i) & 15];
  }
  return {digits.data(), digits.size()};
}

std::optional<std::uint32_t> parse_hex(std::string_view word) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value, 16);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// The fields of the options in the order of the file, by name.
template <typename Options>
auto real_fields(Options& options) {
  return std::array{std::pair{"resolution_m", &options.resolution},
                    std::pair{"max_range_m", &options.max_range},
                    std::pair{"hit", &options.hit},
                    std::pair{"miss", &options.miss},
                    std::pair{"clamp_min", &options.clamp_min},
                    std::pair{"clamp_max", &options.clamp_max}};
}

template <typename Options>
auto flag_fields(Options& options) {
  return std::array{std::pair{"discretize", &options.discretize},
                    std::pair{"weigh_sigma", &options.weigh_sigma}};
}

/// Takes lines off the text, which has passed its checksum.
class IndexReader {
 public:
  IndexReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  template <typename Number>
  Number field(std::string_view key) {
    std::string_view line = next_line();
    const std::string_view word = take_word(line);
    const auto value = parse_number<Number>(take_word(line));
    require(word == key && value && line.empty(), where(), "expected '", key, "' and a number");
    return *value;
  }

  BlockRecord block() {
    std::string_view line = next_line();
    const std::string_view file = take_word(line);
    const auto size = parse_number<std::uint64_t>(take_word(line));
    const auto checksum = parse_hex(take_word(line));
    const auto bricks = parse_number<std::uint64_t>(take_word(line));
    const auto block = block_of_name(file);
    require(block && size && checksum && bricks && line.empty() && *bricks >= 1 &&
                *bricks <= kBricksPerBlock,
            where(),
            "expected block_X_Y_Z.ot, its bytes, its checksum and 1 to ",
            kBricksPerBlock,
            " bricks");
    return {*block, *size, *checksum, *bricks};
  }

  bool at_end() const { return text_.empty(); }

  std::string where() const { return "'" + name_ + "', line " + std::to_string(line_) + ": "; }

 private:
  std::string_view next_line() {
    ++line_;
    return take_line(text_);
  }

  /// block_file_name() backwards; none where that does not give the name again.
  static std::optional<std::uint64_t> block_of_name(std::string_view name) {
    std::string_view rest = name;
    std::uint64_t block = 0;
    if (take_word(rest, "_") != "block") return std::nullopt;
    for (int axis = 0; axis < 3; ++axis) {
      const auto place = parse_number<std::uint64_t>(take_word(rest, "_."));
      if (!place) return std::nullopt;
      block |= spread_bits(*place & 0x1fff) << axis;
    }
    if (block >= kBlockLimit || block_file_name(block) != name) return std::nullopt;
    return block;
  }

  std::string_view text_;
  const std::string& name_;
  int line_ = 1;
};

/// The text between the mark and the checksum. Throws Error unless both are there and right.
std::string_view checked_body(std::string_view text, const std::string& name) {
  std::string_view rest = text;
  const std::string_view first = take_line(rest);
  require(first.starts_with(kMarkOfAll), "'", name, "' is no index of a map in blocks");
  require(first == kBlockIndexMark,
          "'",
          name,
          "' is of version '",
          first.substr(kMarkOfAll.size(), 20),
          "', this program reads version 1; use a later one");
  const std::size_t last = text.rfind(kChecksum);
  const bool whole = last != std::string_view::npos && last > first.size() &&
                     text[last - 1] == '\n' && text.ends_with('\n') &&
                     text.find('\n', last) == text.size() - 1;
  require(whole, "the index '", name, "' ends early; copy it again, or make the map again");
  std::string_view line = text.substr(last + kChecksum.size());
  const auto expected = parse_hex(take_word(line));
  require(expected == checksum(bytes_of_text(text.substr(0, last))),
          "the index '",
          name,
          "' is damaged: its checksum does not fit; copy it again, or make the map again");
  return text.substr(first.size() + 1, last - first.size() - 1);
}

OccupancyOptions take_options(IndexReader& reader) {
  OccupancyOptions options;
  for (const auto& [key, value] : real_fields(options)) *value = reader.field<double>(key);
  for (const auto& [key, value] : flag_fields(options)) *value = reader.field<int>(key) != 0;
  options.check();
  return options;
}

}  // namespace

std::string block_index_text(const BlockIndex& index) {
  std::string text = std::string(kBlockIndexMark) + "\n";
  const auto add = [&](const char* key, const std::string& value) {
    text.append(key).append(" ").append(value).append("\n");
  };
  for (const auto& [key, value] : real_fields(index.options)) add(key, number_text(*value));
  for (const auto& [key, value] : flag_fields(index.options)) add(key, *value ? "1" : "0");
  add("scans", number_text(index.scans));
  add("points", number_text(index.points));
  add("blocks", number_text(index.blocks.size()));
  for (const BlockRecord& record : index.blocks) {
    add(block_file_name(record.block).c_str(),
        number_text(record.size) + " " + hex_text(record.checksum) + " " +
            number_text(record.bricks));
  }
  return text + std::string(kChecksum) + hex_text(checksum(bytes_of_text(text))) + "\n";
}

BlockIndex parse_block_index(std::string_view text, const std::string& name) {
  IndexReader reader(checked_body(text, name), name);
  BlockIndex index{.options = take_options(reader)};
  index.scans = reader.field<std::uint64_t>("scans");
  index.points = reader.field<std::uint64_t>("points");
  const auto blocks = reader.field<std::uint64_t>("blocks");
  while (!reader.at_end()) {
    const BlockRecord record = reader.block();
    require(index.blocks.empty() || index.blocks.back().block < record.block,
            reader.where(),
            "a block stands twice, or not in the order of the octree");
    index.blocks.push_back(record);
  }
  require(index.blocks.size() == blocks,
          "the index '",
          name,
          "' announces ",
          blocks,
          " blocks and names ",
          index.blocks.size());
  return index;
}

}  // namespace facula
