// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/map/octree_file.hpp>
#include <facula/map/octree_header.hpp>

#include <cstdlib>
#include <fstream>
#include <locale>
#include <sstream>
#include <string>

#include <octomap/OcTree.h>

namespace facula {
namespace {

std::string read_bytes(const std::filesystem::path& path) {
  require(std::filesystem::is_regular_file(path),
          "cannot read the map '",
          path.string(),
          "': there is no such file");
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << stream.rdbuf();
  require(stream.is_open() && !stream.bad(), "cannot read the map '", path.string(), "'");
  return std::move(bytes).str();
}

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
void write_binary_header(std::ostream& stream, const octomap::OcTree& tree) {
  stream << "# Octomap OcTree binary file\n"
            "# (feel free to add / change comments, but leave the first line as it is!)\n#\n"
            "id OcTree\nsize "
         << tree.size() << "\nres " << tree.getResolution() << "\ndata\n";
}

/// OctoMap's own writeBinary() changes the tree, and Debian's build of it prints to stderr.
void write_binary(std::ostream& stream, const octomap::OcTree& tree) {
  octomap::OcTree likeliest(tree);
  if (likeliest.getRoot() != nullptr) {
    likeliest.toMaxLikelihood();
    likeliest.prune();
  }
  write_binary_header(stream, likeliest);
  if (likeliest.getRoot() != nullptr) likeliest.writeBinaryNode(stream, likeliest.getRoot());
}

}  // namespace

std::unique_ptr<octomap::OcTree> read_octree(const std::filesystem::path& path) {
  const std::string file = read_bytes(path);
  const OctreeHeader header = parse_octree_header(file, path.string());
  check_octree_nodes(header, file, path.string());
  auto tree = std::make_unique<octomap::OcTree>(header.resolution);
  if (header.nodes == 0) return tree;
  std::istringstream nodes(file.substr(header.data_begin));
  if (header.binary) {
    tree->readBinaryData(nodes);
  } else {
    tree->readData(nodes);
  }
  return tree;
}

void write_octree(const std::filesystem::path& path, const octomap::OcTree& tree) {
  const std::string extension = path.extension().string();
  require(extension == ".ot" || extension == ".bt",
          "cannot write the map '",
          path.string(),
          "': expected a name ending in .ot (probabilities) or .bt (free or occupied)");
  AtomicFile file(path);
  std::ostream& stream = file.stream();
  stream.imbue(std::locale::classic());
  stream.precision(digits_for(tree.getResolution()));
  if (extension == ".bt") {
    write_binary(stream, tree);
  } else {
    tree.write(stream);
  }
  file.commit();
}

}  // namespace facula
