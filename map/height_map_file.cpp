// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/map/height_map.hpp>
#include <facula/map/map_yaml.hpp>

#include <bit>
#include <cstdint>
#include <locale>
#include <string>

namespace facula {
namespace {

void append(std::string& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
}

/// An entry of a TIFF directory with one value: types 3 (16 bits) and 4 (32 bits) of TIFF 6.0.
void append_entry(std::string& bytes, std::uint32_t tag, std::uint32_t type, std::uint32_t value) {
  append(bytes, tag, 2);
  append(bytes, type, 2);
  append(bytes, 1, 4);
  append(bytes, value, 4);
}

/// Everything before the pixels of a grey picture of 32-bit floats in one strip: TIFF 6.0, sections
/// 2, 3 and 19.
std::string tiff_head(const HeightMap& heights) {
  constexpr std::uint32_t kEntries = 11;
  constexpr std::uint32_t kPixels = 8 + 2 + 12 * kEntries + 4;
  const auto cols = static_cast<std::uint32_t>(heights.cols);
  const auto rows = static_cast<std::uint32_t>(heights.rows);
  std::string bytes = "II";
  append(bytes, 42, 2);
  append(bytes, 8, 4);
  append(bytes, kEntries, 2);
  append_entry(bytes, 256, 4, cols);             // ImageWidth
  append_entry(bytes, 257, 4, rows);             // ImageLength
  append_entry(bytes, 258, 3, 32);               // BitsPerSample
  append_entry(bytes, 259, 3, 1);                // Compression: none
  append_entry(bytes, 262, 3, 1);                // PhotometricInterpretation: more is lighter
  append_entry(bytes, 273, 4, kPixels);          // StripOffsets
  append_entry(bytes, 277, 3, 1);                // SamplesPerPixel
  append_entry(bytes, 278, 4, rows);             // RowsPerStrip
  append_entry(bytes, 279, 4, 4 * cols * rows);  // StripByteCounts
  append_entry(bytes, 284, 3, 1);                // PlanarConfiguration
  append_entry(bytes, 339, 3, 3);                // SampleFormat: floating point
  append(bytes, 0, 4);
  return bytes;
}

void write_tiff(std::ostream& out, const HeightMap& heights) {
  const std::string head = tiff_head(heights);
  out.write(head.data(), static_cast<std::streamsize>(head.size()));
  std::string row;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    append(row, std::bit_cast<std::uint32_t>(heights.top[i]), 4);
    if ((i + 1) % static_cast<std::size_t>(heights.cols) != 0) continue;
    out.write(row.data(), static_cast<std::streamsize>(row.size()));
    row.clear();
  }
}

}  // namespace

void write_height_map(const std::filesystem::path& tiff_path, const HeightMap& heights) {
  const std::string extension = tiff_path.extension().string();
  require(extension == ".tif" || extension == ".tiff",
          "cannot write the height map '",
          tiff_path.string(),
          "': expected a name ending in .tif");
  require(heights.rows > 0 && heights.cols > 0 && heights.top.size() == heights.size(),
          "HeightMap: expected ",
          heights.rows,
          " x ",
          heights.cols,
          " heights, got ",
          heights.top.size());
  AtomicFile tiff(tiff_path);
  AtomicFile yaml(std::filesystem::path(tiff_path) += ".yaml");
  write_tiff(tiff.stream(), heights);
  yaml.stream() << "image: " << yaml_scalar(tiff_path.filename().string())
                << "\nresolution: " << exact_text(heights.resolution) << "\norigin: ["
                << exact_text(heights.origin.x()) << ", " << exact_text(heights.origin.y())
                << ", 0]\nunit: m\nno_height: nan\n";
  tiff.commit();
  yaml.commit();
}

}  // namespace facula
