// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/commands/octomap_log.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/reconstruct/filter/scan_filters.hpp>
#include <facula/reconstruct/mesh/mesh_exchange.hpp>

#include <system_error>
#include <utility>

namespace facula {
namespace {

/// A grid knows which points are neighbours, so mixed points can be told; a bare cloud is taken as
/// it is.
void remove_mixed(PolarScan scan, CleanScan& clean) {
  clean.mixed_removed = remove_mixed_points(scan);
  clean.posed.cloud = cloud_from_scan(scan);
  clean.posed.grid = grid_from_scan(scan);
}

bool is_grid(const std::filesystem::path& file) {
  std::error_code unknown;
  return std::filesystem::exists(file, unknown) && file_kind(file) == FileKind::kScan;
}

/// A mesh stands for its vertices.
PosedCloud read_vertices(const std::filesystem::path& path) {
  PosedCloud scan;
  scan.name = path.filename().string();
  scan.cloud.points = read_any_mesh(path).vertices;
  return scan;
}

/// Meshes in .ply files are listed as clouds, which keeps what they know.
std::vector<ListedScan> scans_of(const std::filesystem::path& path) {
  const FileKind kind = file_kind(path);
  require(kind == FileKind::kProject || kind == FileKind::kScan || kind == FileKind::kCloud ||
              kind == FileKind::kMesh,
          "expected a scan, a cloud or a project of scans in '",
          path.string(),
          "', found: ",
          to_string(kind),
          kind == FileKind::kMap ? "; 'facula map merge' adds maps to each other"
                                 : "; 'facula extract' makes scans of captures");
  if (is_octomap_log(path)) return list_log(path);
  if (kind != FileKind::kMesh || lower_extension(path) == ".ply") return list_scans(path);
  return {{.name = path.filename().string(), .file = path, .read = [path] {
             return read_vertices(path);
           }}};
}

}  // namespace

std::vector<ListedScan> list_posed_scans(const std::vector<std::filesystem::path>& paths) {
  std::vector<ListedScan> scans;
  for (const auto& path : paths) {
    for (ListedScan& scan : scans_of(path)) scans.push_back(std::move(scan));
  }
  return scans;
}

CleanScan read_clean_scan(const ListedScan& listed, bool filter) {
  CleanScan clean{.posed = listed.read()};
  clean.points_read = clean.posed.cloud.size();
  if (!is_grid(clean.posed.file)) return clean;
  PolarScan scan = read_scan(clean.posed.file);
  clean.stripes = stripes_of(scan);
  if (filter) remove_mixed(std::move(scan), clean);
  return clean;
}

PosedScans read_posed_scans(const std::vector<std::filesystem::path>& paths, bool filter) {
  PosedScans scans;
  bool all_grids = true;
  for (const ListedScan& listed : list_posed_scans(paths)) {
    CleanScan clean = read_clean_scan(listed, filter);
    scans.points_read += clean.points_read;
    scans.mixed_removed += clean.mixed_removed;
    scans.stripes += clean.stripes.value_or(0);
    all_grids = all_grids && clean.stripes.has_value();
    scans.project.scans.push_back(std::move(clean.posed));
  }
  if (!all_grids) scans.stripes = 0;
  require(scans.points_read > scans.mixed_removed,
          "expected points, got none in '",
          paths.front().string(),
          "'; was the scan empty?");
  return scans;
}

std::size_t stripes_of(const PolarScan& scan) {
  std::size_t stripes = 0;
  for (int col = 0; col < scan.cols; ++col) {
    bool any = false;
    for (int row = 0; row < scan.rows && !any; ++row) any = scan.valid[scan.index(row, col)] != 0;
    if (any) ++stripes;
  }
  return stripes;
}

void require_surface(std::size_t points, std::size_t stripes, const std::filesystem::path& file) {
  require(points > 0, "expected points, got none in '", file.string(), "'; was the scan empty?");
  require(stripes != 1,
          "expected a scan of several stripes, got a single one in '",
          file.string(),
          "', which lies in the laser plane whatever was scanned; move the axis between frames");
}

}  // namespace facula
