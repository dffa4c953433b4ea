// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/color_tree.hpp>
#include <facula/map/octree_file.hpp>
#include <facula/map/octree_header.hpp>
#include <facula/map/pruned_octree.hpp>

#include <cstring>
#include <locale>
#include <ostream>
#include <sstream>

namespace facula {
namespace {

/// Most cells a file may colour: 1 GB of memory.
constexpr std::size_t kMaxColored = std::size_t{1} << 25;

/// Fewest digits (6 as OctoMap writes, else 17) that read back as the same number: OctoMap alone
/// would write a resolution of 1/30 m as another one.
int digits_for(double resolution) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << resolution;
  std::istringstream back(text.str());
  back.imbue(std::locale::classic());
  double read = 0;
  back >> read;
  return read == resolution ? 6 : 17;
}

/// The header as OctoMap writes it, comments included.
void write_header(std::ostream& stream,
                  const char* first_line,
                  const char* id,
                  std::size_t nodes,
                  double resolution) {
  std::ostringstream header;
  header.imbue(std::locale::classic());
  header.precision(digits_for(resolution));
  header << first_line
         << "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
            "id "
         << id << "\nsize " << nodes << "\nres " << resolution << "\ndata\n";
  stream << header.str();
}

/// Puts the leaves of a file into bricks.
class LeafCollector {
 public:
  LeafCollector(OctreeContent& content, const std::string& name, std::size_t max_bricks)
      : map_(content.map), colors_(content.colors), name_(name), max_bricks_(max_bricks) {}

  void add(const OctreeLeaf& leaf) {
    if (leaf.level >= kBrickLevel) return add_bricks(leaf);
    const std::uint64_t code = brick_code(leaf.first);
    if (code != code_) begin_brick(code);
    const int edge = 1 << leaf.level;
    for (int z = 0; z < edge; ++z) {
      for (int y = 0; y < edge; ++y) {
        for (int x = 0; x < edge; ++x) {
          const std::size_t cell =
              cell_in_brick({leaf.first[0] + x, leaf.first[1] + y, leaf.first[2] + z});
          values_[cell] = leaf.value;
          known_.set(cell);
          if (has_color(leaf)) set_color(cell, *leaf.color);
        }
      }
    }
  }

  void finish() {
    if (!known_.none()) map_.find_or_add(code_).assign(values_, known_);
    known_ = {};
    if (!brick_.cells.none()) add_colors();
  }

 private:
  static bool has_color(const OctreeLeaf& leaf) { return leaf.color && *leaf.color != kNoColor; }

  void begin_brick(std::uint64_t code) {
    finish();
    code_ = code;
  }

  void set_color(std::size_t cell, const Color& color) {
    brick_.cells.set(cell);
    sums_[cell] = {1, {color[0], color[1], color[2]}};
  }

  void add_colors() {
    brick_.code = code_;
    for_each_cell(brick_.cells, [&](std::size_t cell) { brick_.sums.push_back(sums_[cell]); });
    colored_ += brick_.sums.size();
    require(colored_ <= kMaxColored,
            "'",
            name_,
            "' colours more than ",
            kMaxColored,
            " cells, which cannot be held");
    colors_.add(std::span(&brick_, 1));
    brick_ = {};
  }

  void add_bricks(const OctreeLeaf& leaf) {
    const std::size_t count = std::size_t{1} << (3 * (leaf.level - kBrickLevel));
    bricks_ += count;
    require(bricks_ <= max_bricks_,
            "'",
            name_,
            "' declares more space free or occupied than can be held: its leaves make more than ",
            max_bricks_,
            " bricks of 8 x 8 x 8 cells");
    const std::uint64_t first = brick_code(leaf.first);
    for (std::size_t i = 0; i < count; ++i) map_.find_or_add(first + i).fill(leaf.value);
    if (!has_color(leaf)) return;
    for (std::size_t i = 0; i < count; ++i) {
      begin_brick(first + i);
      for (std::size_t cell = 0; cell < kCellsPerBrick; ++cell) set_color(cell, *leaf.color);
    }
    finish();
  }

  LogOddsMap& map_;
  CellColors& colors_;
  const std::string& name_;
  ColorBrick brick_;
  std::array<ColorSum, kCellsPerBrick> sums_;
  std::size_t colored_ = 0;
  LogOddsBrick::Values values_{};
  CellMask known_;
  std::uint64_t code_ = 0;
  std::size_t max_bricks_;
  std::size_t bricks_ = 0;
};

void append_bytes(std::string& bytes, const void* data, std::size_t count) {
  bytes.append(static_cast<const char*>(data), count);
}

/// Nodes of a ColorOcTree file.
class ColoredNodes {
 public:
  explicit ColoredNodes(const CellColors& colors) : colors_(colors) {}

  void add(const OctreeNode& node) {
    const std::uint64_t code = cell_code(node.first) >> (3 * node.level);
    if (node.children == 0) return add_leaf(node.level, code, node.value);
    const ColorTree::Node* colored = colors_.find(node.level, code);
    add_node(node.value, colored == nullptr ? kNoColor : colored->color, node.children);
  }

  const std::string& bytes() const { return bytes_; }
  std::size_t count() const { return count_; }

 private:
  /// A leaf of many colours is split into its children.
  void add_leaf(int level, std::uint64_t code, float value) {
    const ColorTree::Node* colored = colors_.find(level, code);
    if (colored == nullptr) return add_node(value, kNoColor, 0);
    if (colored->uniform) return add_node(value, colored->color, 0);
    add_node(value, colored->color, 0xff);
    for (std::uint64_t child = 0; child < 8; ++child) add_leaf(level - 1, code << 3 | child, value);
  }

  void add_node(float value, const Color& color, std::uint8_t children) {
    append_bytes(bytes_, &value, sizeof value);
    append_bytes(bytes_, color.data(), color.size());
    append_bytes(bytes_, &children, 1);
    ++count_;
  }

  ColorTree colors_;
  std::string bytes_;
  std::size_t count_ = 0;
};

}  // namespace

OctreeContent parse_octree(std::string_view file,
                           const LogOddsModel& model,
                           const std::string& name,
                           std::size_t max_leaf_bricks) {
  const OctreeHeader header = parse_octree_header(file, name);
  OctreeContent content{.resolution = header.resolution, .map = {}, .colors = {}};
  check_octree_nodes(header, file, name);
  LeafCollector collector(content, name, max_leaf_bricks);
  for_each_octree_leaf(
      header, file, {model.min, model.max}, [&](const OctreeLeaf& leaf) { collector.add(leaf); });
  collector.finish();
  return content;
}

OctreeContent read_octree(const std::filesystem::path& path, const LogOddsModel& model) {
  return parse_octree(read_whole_file(path), model, path.string());
}

void write_ot(std::ostream& stream, const LogOddsMap& map, double resolution) {
  const PrunedOctree tree(map);
  write_header(stream, "# Octomap OcTree file", "OcTree", tree.size(), resolution);
  std::string bytes;
  bytes.reserve(5 * tree.size());
  tree.for_each_node([&](const OctreeNode& node) {
    append_bytes(bytes, &node.value, sizeof node.value);
    append_bytes(bytes, &node.children, 1);
  });
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void write_color_ot(std::ostream& stream,
                    const LogOddsMap& map,
                    const CellColors& colors,
                    double resolution) {
  ColoredNodes nodes(colors);
  PrunedOctree(map).for_each_node([&](const OctreeNode& node) { nodes.add(node); });
  write_header(stream, "# Octomap OcTree file", "ColorOcTree", nodes.count(), resolution);
  stream.write(nodes.bytes().data(), static_cast<std::streamsize>(nodes.bytes().size()));
}

void write_bt(std::ostream& stream, const LogOddsMap& map, double resolution) {
  // 1 stands for occupied, 0 for free. An inner node holds two bits per child: 1 free leaf, 2
  // occupied leaf, 3 inner node; what its children are is known once they have been met.
  const PrunedOctree tree(map, [](float value) { return is_occupied(value) ? 1.0F : 0.0F; });
  write_header(stream, "# Octomap OcTree binary file", "OcTree", tree.size(), resolution);
  std::string bytes;
  std::array<std::size_t, kTreeDepth + 1> place{};  // of the inner node being written, per level
  tree.for_each_node([&](const OctreeNode& node) {
    const auto level = static_cast<std::size_t>(node.level);
    const bool leaf = node.children == 0;
    if (level < kTreeDepth) {
      const auto bit = [&](std::size_t axis) { return (node.first[axis] >> level & 1) << axis; };
      const int child = bit(0) | bit(1) | bit(2);
      const unsigned kind = !leaf ? 3 : node.value > 0 ? 2 : 1;
      const unsigned shift = 2 * static_cast<unsigned>(child);
      char& two = bytes[place[level + 1] + shift / 8];
      two = static_cast<char>(static_cast<unsigned char>(two) | kind << shift % 8);
    }
    if (leaf) return;
    place[level] = bytes.size();
    bytes.append(2, '\0');
  });
  if (tree.size() == 1) bytes.append(2, '\0');  // all space is one leaf
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace facula
