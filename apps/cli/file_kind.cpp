// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/acquire/rig/toml_table.hpp>
#include <facula/apps/cli/file_kind.hpp>

#include <fstream>
#include <system_error>

namespace facula {
namespace {

namespace fs = std::filesystem;

/// The number behind `words` in the header of a file; 0 when it is not there.
long header_number(const fs::path& path, const std::string& words) {
  constexpr std::size_t kLongestHeader = std::size_t{1} << 16;
  std::string text(kLongestHeader, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  std::string_view rest = text;
  while (!rest.empty()) {
    std::string_view line = take_line(rest);
    if (!line.starts_with(words + " ")) continue;
    line.remove_prefix(words.size());
    return parse_number<long>(take_word(line)).value_or(0);
  }
  return 0;
}

/// By its first bytes, or by its name, so that a damaged one is called by what it should be.
bool is_stripe_log(const fs::path& path) {
  std::string magic(7, '\0');
  std::ifstream(path, std::ios::binary).read(magic.data(), 7);
  return magic == "FACULOG" || lower_extension(path) == ".flog";
}

FileKind toml_kind(const fs::path& path) {
  const TomlTable table = TomlTable::from_file(path);
  if (table.has("scan")) return FileKind::kProject;
  if (table.has("object")) return FileKind::kScene;
  if (table.has("camera")) return FileKind::kRig;
  return FileKind::kCapture;
}

FileKind folder_kind(const fs::path& path) {
  if (fs::exists(path / "capture.toml")) return FileKind::kCapture;
  for (const auto& entry : fs::directory_iterator(path)) {
    if (entry.path().extension() == ".pose") return FileKind::kProject;
  }
  fail("expected a folder with capture.toml or with 3DTK scans (scanNNN.3d and .pose), got '",
       path.string(),
       "' with neither; name a file in it");
}

}  // namespace

FileKind file_kind(const fs::path& path) {
  std::error_code unknown;
  require(fs::exists(path, unknown),
          "expected a file, got nothing at '",
          path.string(),
          "'; check the path");
  if (fs::is_directory(path, unknown)) return folder_kind(path);
  if (is_stripe_log(path)) return FileKind::kLog;
  std::string extension = lower_extension(path);
  if (extension == ".gz" || extension == ".xz") extension = lower_extension(path.stem());
  if (extension == ".toml") return toml_kind(path);
  if (extension == ".conf" || extension == ".graph") return FileKind::kProject;
  if (extension == ".pcd") {
    return header_number(path, "HEIGHT") > 1 ? FileKind::kScan : FileKind::kCloud;
  }
  if (extension == ".ply") {
    return header_number(path, "element face") > 0 ? FileKind::kMesh : FileKind::kCloud;
  }
  for (const char* mesh : {".obj", ".stl", ".off", ".glb"}) {
    if (extension == mesh) return FileKind::kMesh;
  }
  for (const char* map : {".bt", ".ot", ".fmap", ".blocks"}) {
    if (extension == map) return FileKind::kMap;
  }
  if (extension == ".yaml" || extension == ".yml") return FileKind::kGrid;
  for (const char* points : {".asc", ".xyz", ".txt", ".csv", ".dat", ".3d"}) {
    if (extension == points) return FileKind::kCloud;
  }
  fail(
      "expected a file that facula reads (.toml, .flog, .pcd, .ply, .asc, .xyz, .csv, .obj, .stl, "
      ".off, .glb, .bt, .ot, .fmap, .blocks, .yaml, .conf, .graph or a folder), got '",
      path.string(),
      "'; convert it first");
}

std::string to_string(FileKind kind) {
  switch (kind) {
    case FileKind::kRig:
      return "rig";
    case FileKind::kScene:
      return "scene";
    case FileKind::kCapture:
      return "capture";
    case FileKind::kLog:
      return "stripe log";
    case FileKind::kProject:
      return "project of posed scans";
    case FileKind::kScan:
      return "scan";
    case FileKind::kCloud:
      return "point cloud";
    case FileKind::kMesh:
      return "mesh";
    case FileKind::kMap:
      return "occupancy map";
    case FileKind::kGrid:
      return "navigation grid";
  }
  return "file";
}

}  // namespace facula
