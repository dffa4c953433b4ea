// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_formats.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>

#include <cmath>
#include <optional>

namespace facula {
namespace {

/// What was read so far, and where.
struct Reading {
  const std::filesystem::path& path;
  std::size_t line = 0;
  TriangleMesh mesh;
  std::vector<Eigen::Vector3f> normals;  ///< as listed, not yet given to vertices
  bool normals_match = true;             ///< every corner names the same vertex and normal
};

std::optional<Eigen::Vector3f> take_vector(std::string_view& text) {
  Eigen::Vector3f vector;
  for (int k = 0; k < 3; ++k) {
    const auto value = parse_number<double>(take_word(text));
    if (!value) return std::nullopt;
    vector[k] = static_cast<float>(*value);
  }
  return vector;
}

Eigen::Vector3f needed_vector(std::string_view& text, const Reading& reading) {
  const auto vector = take_vector(text);
  require(vector.has_value(),
          "line ",
          reading.line,
          " of '",
          reading.path.string(),
          "' does not hold three numbers; expected x y z");
  return *vector;
}

void read_vertex(std::string_view text, Reading& reading) {
  TriangleMesh& mesh = reading.mesh;
  mesh.vertices.push_back(needed_vector(text, reading));
  const auto color = take_vector(text);  // a common extension: red green blue in [0..1]
  if (!color || mesh.colors.size() + 1 != mesh.vertices.size()) return;
  Color bytes{};
  for (int k = 0; k < 3; ++k) {
    const float value = (*color)[k];
    const float part = value > 0 ? std::min(value, 1.0F) : 0.0F;
    bytes[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(part * 255));
  }
  mesh.colors.push_back(bytes);
}

/// The index (from 0) that an OBJ index means: from 1, or backwards from the last one at -1.
std::uint32_t index_of(std::string_view word, std::size_t count, const Reading& reading) {
  const auto number = parse_number<long long>(word);
  const auto size = static_cast<long long>(count);
  const long long index = number.value_or(0) > 0 ? *number - 1 : number.value_or(0) + size;
  require(number && *number != 0 && index >= 0 && index < size,
          "line ",
          reading.line,
          " of '",
          reading.path.string(),
          "' names '",
          word.substr(0, 40),
          "' where ",
          size,
          " are listed; indices count from 1");
  return static_cast<std::uint32_t>(index);
}

void read_face(std::string_view text, Reading& reading) {
  std::vector<std::uint32_t> corners;
  for (auto word = take_word(text); !word.empty(); word = take_word(text)) {
    const std::size_t slash = word.find('/');
    corners.push_back(index_of(word.substr(0, slash), reading.mesh.vertices.size(), reading));
    const std::size_t last = word.rfind('/');
    const bool has_normal = last != slash && last + 1 < word.size();
    reading.normals_match =
        reading.normals_match && has_normal &&
        index_of(word.substr(last + 1), reading.normals.size(), reading) == corners.back();
  }
  add_fan(reading.mesh, corners, reading.path);
}

}  // namespace

TriangleMesh read_obj_mesh(const std::filesystem::path& path) {
  const std::string bytes = read_whole_file(path);
  std::string_view rest = bytes;
  Reading reading{path, 0, {}, {}};
  while (!rest.empty()) {
    std::string_view line = take_line(rest);
    ++reading.line;
    const std::string_view keyword = take_word(line);
    if (keyword == "v") read_vertex(line, reading);
    if (keyword == "vn") reading.normals.push_back(needed_vector(line, reading));
    if (keyword == "f") read_face(line, reading);
  }
  TriangleMesh& mesh = reading.mesh;
  if (mesh.colors.size() != mesh.vertices.size()) mesh.colors.clear();
  if (reading.normals_match && reading.normals.size() == mesh.vertices.size()) {
    mesh.normals = std::move(reading.normals);
  }
  return std::move(mesh);
}

void write_obj_mesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  AtomicFile file(path);
  const auto put = [&](const Eigen::Vector3f& v) {
    file.stream() << ' ' << number_text(v.x()) << ' ' << number_text(v.y()) << ' '
                  << number_text(v.z());
  };
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    file.stream() << 'v';
    put(mesh.vertices[i]);
    if (!mesh.colors.empty()) {
      const Color& c = mesh.colors[i];
      put(Eigen::Vector3f(c[0], c[1], c[2]) / 255.0F);
    }
    file.stream() << '\n';
  }
  for (const auto& normal : mesh.normals) {
    file.stream() << "vn";
    put(normal);
    file.stream() << '\n';
  }
  for (const auto& triangle : mesh.triangles) {
    file.stream() << 'f';
    for (const std::uint32_t v : triangle) {
      const std::string index = number_text(std::size_t{v} + 1);
      file.stream() << ' ' << index;
      if (!mesh.normals.empty()) file.stream() << "//" << index;
    }
    file.stream() << '\n';
  }
  file.commit();
}

}  // namespace facula
