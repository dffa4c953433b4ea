// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/reconstruct/filter/scan_filters.hpp>
#include <facula/reconstruct/mesh/mesh_exchange.hpp>

#include <system_error>
#include <utility>

namespace facula {
namespace {

/// A grid knows which points are neighbours, so mixed points can be told; a bare cloud is taken as
/// it is.
void clean_scan(const PolarScan& read, PosedCloud& posed, PosedScans& scans) {
  PolarScan scan = read;
  scans.mixed_removed += remove_mixed_points(scan);
  posed.cloud = cloud_from_scan(scan);
  posed.grid = grid_from_scan(scan);
}

bool is_grid(const std::filesystem::path& file) {
  std::error_code unknown;
  return std::filesystem::exists(file, unknown) && file_kind(file) == FileKind::kScan;
}

/// A mesh stands for its vertices; .ply files are read as clouds, which keeps what they know.
ScanProject scans_of(const std::filesystem::path& path, FileKind kind) {
  if (kind != FileKind::kMesh || lower_extension(path) == ".ply") return read_scan_project(path);
  ScanProject project;
  project.scans.emplace_back();
  project.scans.front().name = path.filename().string();
  project.scans.front().cloud.points = read_any_mesh(path).vertices;
  return project;
}

}  // namespace

PosedScans read_posed_scans(const std::vector<std::filesystem::path>& paths, bool filter) {
  PosedScans scans;
  bool all_grids = true;
  for (const auto& path : paths) {
    const FileKind kind = file_kind(path);
    require(kind == FileKind::kProject || kind == FileKind::kScan || kind == FileKind::kCloud ||
                kind == FileKind::kMesh,
            "expected a scan, a cloud or a project of scans, got a ",
            to_string(kind),
            " in '",
            path.string(),
            "'; 'facula extract' makes scans of captures");
    ScanProject project = scans_of(path, kind);
    for (PosedCloud& posed : project.scans) {
      scans.points_read += posed.cloud.size();
      if (is_grid(posed.file)) {
        const PolarScan scan = read_scan(posed.file);
        scans.stripes += stripes_of(scan);
        if (filter) clean_scan(scan, posed, scans);
      } else {
        all_grids = false;
      }
      scans.project.scans.push_back(std::move(posed));
    }
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
