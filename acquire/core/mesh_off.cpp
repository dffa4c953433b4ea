// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/mesh_formats.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace facula {
namespace {

/// The lines of an OFF file that hold something, without comments.
class OffLines {
 public:
  OffLines(std::string_view text, const std::filesystem::path& path) : rest_(text), path_(path) {}

  /// The next line; throws Error saying what was expected where there is none.
  std::string_view next(const char* expected) {
    while (!rest_.empty()) {
      std::string_view line = take_line(rest_);
      ++number_;
      line = line.substr(0, line.find('#'));
      if (line.find_first_not_of(" \t\r\v\f") != std::string_view::npos) return line;
    }
    fail("'", path_.string(), "' ends where ", expected, " was expected; the file is torn");
  }

  /// The number at the front of `line`.
  template <typename Number>
  Number number(std::string_view& line, const char* expected) const {
    const std::string_view word = take_word(line);
    const auto value = parse_number<Number>(word);
    require(value.has_value(),
            "line ",
            number_,
            " of '",
            path_.string(),
            "' has '",
            word.substr(0, 40),
            "' where ",
            expected,
            " was expected");
    return *value;
  }

  const std::filesystem::path& path() const { return path_; }
  std::size_t bytes_left() const { return rest_.size(); }

 private:
  std::string_view rest_;
  const std::filesystem::path& path_;
  std::size_t number_ = 0;
};

struct OffHeader {
  bool colors = false;   ///< COFF
  bool normals = false;  ///< NOFF, CNOFF
  std::size_t vertices = 0;
  std::size_t faces = 0;
};

OffHeader take_header(OffLines& lines) {
  OffHeader header;
  std::string_view line = lines.next("the word OFF");
  const std::string_view word = take_word(line);
  require(word == "OFF" || word == "COFF" || word == "NOFF" || word == "CNOFF",
          "'",
          lines.path().string(),
          "' begins with '",
          word.substr(0, 40),
          "'; expected an OFF file (OFF, COFF, NOFF or CNOFF)");
  header.colors = word.starts_with('C');
  header.normals = word.find('N') != std::string_view::npos;
  if (line.find_first_not_of(" \t") == std::string_view::npos) line = lines.next("the counts");
  header.vertices = lines.number<std::size_t>(line, "the number of vertices");
  header.faces = lines.number<std::size_t>(line, "the number of faces");
  // A vertex takes six bytes at least and a face eight: huge counts of torn files end here.
  require(
      header.vertices <= lines.bytes_left() / 6 + 1 && header.faces <= lines.bytes_left() / 6 + 1,
      "'",
      lines.path().string(),
      "' announces ",
      header.vertices,
      " vertices and ",
      header.faces,
      " faces in ",
      lines.bytes_left(),
      " bytes; the file is torn");
  return header;
}

Eigen::Vector3f take_vector(std::string_view& line, const OffLines& lines) {
  Eigen::Vector3f v;
  for (int k = 0; k < 3; ++k) v[k] = static_cast<float>(lines.number<double>(line, "a number"));
  return v;
}

/// Whole numbers of 0..255, or shares of 1 where one has a decimal point.
Color take_color(std::string_view& line, const OffLines& lines) {
  const bool shares = line.find('.') != std::string_view::npos;
  Color color{};
  for (auto& part : color) {
    const double value = lines.number<double>(line, "a colour") * (shares ? 255 : 1);
    part = static_cast<std::uint8_t>(std::lround(value > 0 ? std::min(value, 255.0) : 0.0));
  }
  return color;
}

void take_face(std::string_view line, const OffLines& lines, TriangleMesh& mesh) {
  const auto count = lines.number<std::size_t>(line, "a number of corners");
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < count; ++i) {
    const auto index = lines.number<std::uint32_t>(line, "the index of a vertex");
    corners.push_back(index);
  }
  add_fan(mesh, corners, lines.path());
}

}  // namespace

TriangleMesh read_off_mesh(const std::filesystem::path& path) {
  const std::string text = read_whole_file(path);
  OffLines lines(text, path);
  const OffHeader header = take_header(lines);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < header.vertices; ++i) {
    std::string_view line = lines.next("a vertex");
    mesh.vertices.push_back(take_vector(line, lines));
    if (header.normals) mesh.normals.push_back(take_vector(line, lines));
    if (header.colors) mesh.colors.push_back(take_color(line, lines));
  }
  for (std::size_t i = 0; i < header.faces; ++i) take_face(lines.next("a face"), lines, mesh);
  return mesh;
}

void write_off_mesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  out << (mesh.colors.empty() ? "OFF\n" : "COFF\n");
  out << number_text(mesh.vertices.size()) << ' ' << number_text(mesh.triangles.size()) << " 0\n";
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& v = mesh.vertices[i];
    out << number_text(v.x()) << ' ' << number_text(v.y()) << ' ' << number_text(v.z());
    if (!mesh.colors.empty()) {
      for (const std::uint8_t part : mesh.colors[i]) out << ' ' << number_text(int{part});
      out << " 255";
    }
    out << '\n';
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    out << "3 " << number_text(a) << ' ' << number_text(b) << ' ' << number_text(c) << '\n';
  }
  file.commit();
}

}  // namespace facula
