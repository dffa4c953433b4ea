// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/mesh_formats.hpp>
#include <facula/acquire/core/number_column.hpp>
#include <facula/acquire/core/text_numbers.hpp>

#include <algorithm>
#include <array>
#include <cmath>

// glTF 2.0 (Khronos Group, ISO/IEC 12113:2022): one JSON chunk, one binary chunk.

namespace facula {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJson = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinary = 0x004E4942;  // "BIN"
constexpr int kFloat = 5126;
constexpr int kUint32 = 5125;
constexpr int kVertices = 34962;  // ARRAY_BUFFER
constexpr int kIndices = 34963;   // ELEMENT_ARRAY_BUFFER

void put(std::string& bytes, std::uint32_t value) {
  encode_number(bytes, NumberType::kUint32, value);
}

/// z up becomes y up.
Eigen::Vector3f y_up(const Eigen::Vector3f& v) {
  return {v.x(), v.z(), -v.y()};
}

/// glTF's vertex colours are linear, ours are those of a screen (IEC 61966-2-1).
float linear_light(std::uint8_t screen) {
  const double c = screen / 255.0;
  return static_cast<float>(c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4));
}

/// The binary chunk and what the JSON chunk says of it.
class GlbParts {
 public:
  /// Adds an accessor over the bytes added since the last one; returns its number.
  int add_view(
      int target, int type, const char* shape, std::size_t count, const std::string& limits = "") {
    const std::size_t length = binary.size() - begin_;
    views_ += std::string(views_.empty() ? "" : ",") + R"({"buffer":0,"byteOffset":)" +
              number_text(begin_) + R"(,"byteLength":)" + number_text(length) + R"(,"target":)" +
              number_text(target) + "}";
    accessors_ += std::string(accessors_.empty() ? "" : ",") + R"({"bufferView":)" +
                  number_text(views_count_) + R"(,"componentType":)" + number_text(type) +
                  R"(,"count":)" + number_text(count) + R"(,"type":")" + shape + "\"" + limits +
                  "}";
    begin_ = binary.size();
    return views_count_++;
  }

  std::string json(const std::string& attributes, int indices) const {
    return R"({"asset":{"version":"2.0","generator":"Facula"},"scene":0,"scenes":[{"nodes":[0]}],)"
           R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{)" +
           attributes + R"(},"indices":)" + number_text(indices) +
           R"(,"material":0}]}],"materials":[{"doubleSided":true,"pbrMetallicRoughness":)"
           R"({"metallicFactor":0,"roughnessFactor":0.8}}],"buffers":[{"byteLength":)" +
           number_text(binary.size()) + R"(}],"bufferViews":[)" + views_ + R"(],"accessors":[)" +
           accessors_ + "]}";
  }

  void put_vector(const Eigen::Vector3f& v) {
    for (int k = 0; k < 3; ++k) encode_number(binary, NumberType::kFloat32, v[k]);
  }

  std::string binary;

 private:
  std::string views_;
  std::string accessors_;
  std::size_t begin_ = 0;
  int views_count_ = 0;
};

std::string vector_text(const Eigen::Vector3f& v) {
  return "[" + number_text(v.x()) + "," + number_text(v.y()) + "," + number_text(v.z()) + "]";
}

/// Positions, with the bounds that glTF demands.
int add_positions(GlbParts& parts, const TriangleMesh& mesh) {
  Eigen::Vector3f low = y_up(mesh.vertices.front());
  Eigen::Vector3f high = low;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3f v = y_up(vertex);
    parts.put_vector(v);
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return parts.add_view(kVertices,
                        kFloat,
                        "VEC3",
                        mesh.vertices.size(),
                        ",\"min\":" + vector_text(low) + ",\"max\":" + vector_text(high));
}

std::string add_attributes(GlbParts& parts, const TriangleMesh& mesh) {
  std::string attributes = "\"POSITION\":" + number_text(add_positions(parts, mesh));
  if (!mesh.normals.empty()) {
    for (const Eigen::Vector3f& normal : mesh.normals) parts.put_vector(y_up(normal));
    const int view = parts.add_view(kVertices, kFloat, "VEC3", mesh.normals.size());
    attributes += ",\"NORMAL\":" + number_text(view);
  }
  if (!mesh.colors.empty()) {
    std::array<float, 256> linear{};
    for (int i = 0; i < 256; ++i) {
      linear[static_cast<std::size_t>(i)] = linear_light(static_cast<std::uint8_t>(i));
    }
    for (const Color& color : mesh.colors) {
      parts.put_vector({linear[color[0]], linear[color[1]], linear[color[2]]});
    }
    const int view = parts.add_view(kVertices, kFloat, "VEC3", mesh.colors.size());
    attributes += ",\"COLOR_0\":" + number_text(view);
  }
  return attributes;
}

void put_chunk(std::string& bytes, std::uint32_t type, std::string data, char filling) {
  while (data.size() % 4 != 0) data += filling;
  put(bytes, static_cast<std::uint32_t>(data.size()));
  put(bytes, type);
  bytes += data;
}

}  // namespace

void write_glb_mesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  GlbParts parts;
  const std::string attributes = add_attributes(parts, mesh);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) put(parts.binary, v);
  }
  const int indices = parts.add_view(kIndices, kUint32, "SCALAR", 3 * mesh.triangles.size());
  std::string chunks;
  put_chunk(chunks, kJson, parts.json(attributes, indices), ' ');
  put_chunk(chunks, kBinary, std::move(parts.binary), '\0');
  std::string header;
  put(header, kMagic);
  put(header, 2);
  put(header, static_cast<std::uint32_t>(12 + chunks.size()));
  AtomicFile file(path);
  file.stream().write(header.data(), static_cast<std::streamsize>(header.size()));
  file.stream().write(chunks.data(), static_cast<std::streamsize>(chunks.size()));
  file.commit();
}

}  // namespace facula
