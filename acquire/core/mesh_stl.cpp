// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_formats.hpp>
#include <facula/acquire/core/number_column.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>

#include <map>

namespace facula {
namespace {

constexpr std::size_t kHeader = 80;    ///< free text [byte]
constexpr std::size_t kTriangle = 50;  ///< normal, three corners, two spare bytes [byte]

/// Joins equal corners, which an STL file repeats for every triangle.
class Joiner {
 public:
  explicit Joiner(TriangleMesh& mesh) : mesh_(mesh) {}

  /// A triangle that joining makes an edge or a point is left out.
  void add(const std::array<Eigen::Vector3f, 3>& corners) {
    const TriangleMesh::Triangle t{index(corners[0]), index(corners[1]), index(corners[2])};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh_.triangles.push_back(t);
  }

 private:
  std::uint32_t index(const Eigen::Vector3f& corner) {
    const auto next = static_cast<std::uint32_t>(mesh_.vertices.size());
    const auto [found, is_new] =
        known_.try_emplace(std::array<float, 3>{corner.x(), corner.y(), corner.z()}, next);
    if (is_new) mesh_.vertices.push_back(corner);
    return found->second;
  }

  TriangleMesh& mesh_;
  std::map<std::array<float, 3>, std::uint32_t> known_;
};

[[noreturn]] void fail_vertex(const std::filesystem::path& path) {
  fail(
      "the mesh of '", path.string(), "' has a vertex that is not a finite point; repair the mesh");
}

void read_binary(std::string_view bytes, Joiner& joiner, const std::filesystem::path& path) {
  for (bytes.remove_prefix(kHeader + 4); !bytes.empty(); bytes.remove_prefix(kTriangle)) {
    std::array<Eigen::Vector3f, 3> corners;
    for (std::size_t k = 0; k < 9; ++k) {
      const char* number = bytes.data() + 12 + 4 * k;
      corners[k / 3][static_cast<int>(k % 3)] =
          static_cast<float>(decode_number(number, NumberType::kFloat32, false));
    }
    for (const auto& corner : corners) {
      if (!corner.allFinite()) fail_vertex(path);  // NaN has no place in the order of known corners
    }
    joiner.add(corners);
  }
}

Eigen::Vector3f take_corner(std::string_view& text, const std::filesystem::path& path) {
  Eigen::Vector3f corner;
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = take_word(text);
    const auto value = parse_number<double>(word);
    require(value.has_value(),
            "'",
            path.string(),
            "' has '",
            word.substr(0, 40),
            "' where a vertex needs a number; the file is torn");
    corner[k] = static_cast<float>(*value);
  }
  if (!corner.allFinite()) fail_vertex(path);
  return corner;
}

void read_text(std::string_view text, Joiner& joiner, const std::filesystem::path& path) {
  std::array<Eigen::Vector3f, 3> corners;
  std::size_t seen = 0;
  bool ended = false;
  take_line(text);  // "solid" and a name, which may be any words
  for (auto word = take_word(text); !word.empty(); word = take_word(text)) {
    ended = word == "endsolid";
    if (ended) take_line(text);
    if (word != "vertex" && word != "endloop") continue;
    require((word == "vertex") == (seen < 3),
            "a facet of '",
            path.string(),
            "' has not exactly three vertices; the file is torn");
    if (word == "vertex") {
      corners[seen++] = take_corner(text, path);
    } else {
      joiner.add(corners);
      seen = 0;
    }
  }
  require(ended, "the STL file '", path.string(), "' has no endsolid; the file is torn");
}

}  // namespace

TriangleMesh read_stl_mesh(const std::filesystem::path& path) {
  const std::string bytes = read_whole_file(path);
  TriangleMesh mesh;
  Joiner joiner(mesh);
  std::size_t count = 0;
  if (bytes.size() >= kHeader + 4) {
    count =
        static_cast<std::size_t>(decode_number(bytes.data() + kHeader, NumberType::kUint32, false));
  }
  // Binary files may start with "solid" too, so the size decides.
  if (bytes.size() == kHeader + 4 + count * kTriangle) {
    read_binary(bytes, joiner, path);
  } else {
    require(bytes.starts_with("solid"),
            "'",
            path.string(),
            "' of ",
            bytes.size(),
            " bytes is no STL file, or a torn one with ",
            count,
            " triangles; copy it again");
    read_text(bytes, joiner, path);
  }
  return mesh;
}

void write_stl_mesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  AtomicFile file(path);
  std::string bytes(kHeader, ' ');
  encode_number(bytes, NumberType::kUint32, static_cast<double>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    const std::array<Eigen::Vector3f, 3> corners{
        mesh.vertices[triangle[0]], mesh.vertices[triangle[1]], mesh.vertices[triangle[2]]};
    const Eigen::Vector3f normal =
        (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    for (const auto& vector : {normal, corners[0], corners[1], corners[2]}) {
      for (int k = 0; k < 3; ++k) encode_number(bytes, NumberType::kFloat32, vector[k]);
    }
    bytes.append(2, '\0');
  }
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

}  // namespace facula
