// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/map/largest_cell.hpp>
#include <facula/map/octree_header.hpp>

#include <charconv>
#include <cmath>
#include <cstring>

namespace facula {
namespace {

constexpr std::string_view kTextStart = "# Octomap OcTree file";
/// Red, green, blue.
constexpr std::size_t kColorSize = 3;

constexpr std::string_view kBinaryStart = "# Octomap OcTree binary file";

template <typename Number>
Number number_of(std::string_view text, std::string_view key, const std::string& name) {
  Number value{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  require(failure == std::errc() && end == text.data() + text.size(),
          "'",
          name,
          "': expected a number after '",
          key,
          "' in the header, found '",
          text,
          "'");
  return value;
}

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// Reads `line` ("key value") into the header.
void read_entry(std::string_view line, OctreeHeader& header, const std::string& name) {
  const auto space = line.find_first_of(" \t");
  const std::string_view key = line.substr(0, space);
  const std::string_view value =
      space == std::string_view::npos ? std::string_view() : trimmed(line.substr(space));
  if (key == "id") {
    header.colored = value == "ColorOcTree";
    require(header.colored || value == "OcTree",
            "'",
            name,
            "' holds a '",
            value,
            "'; only occupancy maps ('OcTree', 'ColorOcTree') are read");
  } else if (key == "size") {
    header.nodes = number_of<std::size_t>(value, key, name);
  } else if (key == "res") {
    header.resolution = number_of<double>(value, key, name);
  }
}

/// Counts nodes; stops with an Error where the bytes make no tree.
class NodeWalk {
 public:
  NodeWalk(std::string_view bytes, bool colored, const std::string& name)
      : bytes_(bytes), name_(name), colored_(colored) {}

  std::size_t nodes() const { return nodes_; }
  std::size_t bytes_left() const { return bytes_.size(); }

  /// .ot: log-odds as float, then one bit per child, then the children.
  void walk_text_node(int depth) {
    begin_node(depth);
    float value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    require(std::isfinite(value), "'", name_, "' is damaged: a node's value is not a number");
    if (colored_) take(kColorSize);
    const auto children = static_cast<unsigned char>(take(1)[0]);
    for (int i = 0; i < 8; ++i) {
      if ((children >> i & 1) != 0) walk_text_node(depth + 1);
    }
  }

  /// .bt: two bits per child: 1 free leaf, 2 occupied leaf, 3 inner node.
  void walk_binary_node(int depth) {
    begin_node(depth);
    const std::string_view two = take(2);
    const unsigned children = static_cast<unsigned char>(two[0]) |
                              static_cast<unsigned>(static_cast<unsigned char>(two[1])) << 8;
    require(children != 0, "'", name_, "' is damaged: an inner node has no children");
    for (int i = 0; i < 8; ++i) {
      const unsigned kind = children >> (2 * i) & 3;
      if (kind == 1 || kind == 2) begin_node(depth + 1);
      if (kind == 3) walk_binary_node(depth + 1);
    }
  }

 private:
  void begin_node(int depth) {
    require(depth <= kTreeDepth, "'", name_, "' is damaged: its tree is deeper than 16 levels");
    ++nodes_;
  }

  std::string_view take(std::size_t count) {
    require(bytes_.size() >= count,
            "'",
            name_,
            "' is torn: it ends after ",
            nodes_,
            " nodes, in the middle of the tree; copy or write it again");
    const std::string_view taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  std::string_view bytes_;
  const std::string& name_;
  bool colored_;
  std::size_t nodes_ = 0;
};

/// Reads the leaves of a file that is known to be whole.
class LeafWalk {
 public:
  LeafWalk(std::string_view bytes,
           bool colored,
           std::pair<float, float> free_and_occupied,
           const std::function<void(const OctreeLeaf&)>& visit)
      : bytes_(bytes), colored_(colored), free_and_occupied_(free_and_occupied), visit_(visit) {}

  void walk_text_node(int level, const CellKey& first) {
    float value = 0;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    std::optional<Color> color;
    if (colored_) {
      std::memcpy(color.emplace().data(), bytes_.data(), kColorSize);
      bytes_.remove_prefix(kColorSize);
    }
    const auto children = static_cast<unsigned char>(bytes_[0]);
    bytes_.remove_prefix(1);
    if (children == 0) return visit_({level, first, value, color});
    for (int i = 0; i < 8; ++i) {
      if ((children >> i & 1) != 0) walk_text_node(level - 1, child_of(first, level, i));
    }
  }

  void walk_binary_node(int level, const CellKey& first) {
    const unsigned children = static_cast<unsigned char>(bytes_[0]) |
                              static_cast<unsigned>(static_cast<unsigned char>(bytes_[1])) << 8;
    bytes_.remove_prefix(2);
    for (int i = 0; i < 8; ++i) {
      const unsigned kind = children >> (2 * i) & 3;
      const CellKey child = child_of(first, level, i);
      if (kind == 1) visit_({level - 1, child, free_and_occupied_.first});
      if (kind == 2) visit_({level - 1, child, free_and_occupied_.second});
      if (kind == 3) walk_binary_node(level - 1, child);
    }
  }

 private:
  static CellKey child_of(const CellKey& first, int level, int child) {
    const int edge = 1 << (level - 1);
    return {first[0] + (child & 1) * edge,
            first[1] + (child >> 1 & 1) * edge,
            first[2] + (child >> 2 & 1) * edge};
  }

  std::string_view bytes_;
  bool colored_;
  std::pair<float, float> free_and_occupied_;
  const std::function<void(const OctreeLeaf&)>& visit_;
};

}  // namespace

OctreeHeader parse_octree_header(std::string_view file, const std::string& name) {
  OctreeHeader header;
  header.binary = file.starts_with(kBinaryStart);
  require(header.binary || file.starts_with(kTextStart),
          "'",
          name,
          "' is not an OctoMap file: expected '",
          kTextStart,
          "' or '",
          kBinaryStart,
          "' in its first line");
  bool has_id = false;
  for (std::size_t begin = 0; begin < file.size();) {
    const auto end = file.find('\n', begin);
    if (end == std::string_view::npos) break;
    const std::string_view line = trimmed(file.substr(begin, end - begin));
    begin = end + 1;
    if (line == "data") {
      header.data_begin = begin;
      break;
    }
    if (line.empty() || line.front() == '#') continue;
    has_id = has_id || line.starts_with("id");
    read_entry(line, header, name);
  }
  require(header.data_begin != 0, "'", name, "' is torn: its header has no line 'data'");
  require(has_id, "'", name, "' is damaged: its header has no line 'id'");
  require(header.resolution > 0 && header.resolution <= kLargestCell,  // catches NaN too
          "'",
          name,
          "': expected a resolution ('res') above 0 m and at most ",
          kLargestCell,
          " m in the header, found ",
          header.resolution);
  return header;
}

void check_octree_nodes(const OctreeHeader& header,
                        std::string_view file,
                        const std::string& name) {
  NodeWalk walk(file.substr(header.data_begin), header.colored, name);
  if (header.nodes > 0 && header.binary) walk.walk_binary_node(0);
  if (header.nodes > 0 && !header.binary) walk.walk_text_node(0);
  require(walk.nodes() == header.nodes && walk.bytes_left() == 0,
          "'",
          name,
          "' is damaged: its header says ",
          header.nodes,
          " nodes, its data hold ",
          walk.nodes(),
          " and ",
          walk.bytes_left(),
          " bytes more");
}

void for_each_octree_leaf(const OctreeHeader& header,
                          std::string_view file,
                          std::pair<float, float> free_and_occupied,
                          const std::function<void(const OctreeLeaf&)>& visit) {
  if (header.nodes == 0) return;
  LeafWalk walk(file.substr(header.data_begin), header.colored, free_and_occupied, visit);
  if (header.binary) {
    walk.walk_binary_node(kTreeDepth, {0, 0, 0});
  } else {
    walk.walk_text_node(kTreeDepth, {0, 0, 0});
  }
}

}  // namespace facula
