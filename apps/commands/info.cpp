// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/scene.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/commands/info.hpp>
#include <facula/apps/commands/info_figures.hpp>
#include <facula/apps/commands/log_figures.hpp>
#include <facula/apps/commands/map_figures.hpp>
#include <facula/apps/commands/octomap_log.hpp>
#include <facula/reconstruct/mesh/mesh_exchange.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <memory>

namespace facula {
namespace {

struct InfoArguments {
  std::filesystem::path file;
  std::filesystem::path frames;
};

void declare(Arguments& arguments, InfoArguments& a) {
  arguments.input(
      "FILE",
      a.file,
      "a rig, scene, capture, stripe log, scan, cloud, mesh, project (poses.toml, .conf, .graph, "
      "folder), map (.bt, .ot, .fmap) or navigation grid (.yaml)");
  arguments.required();
  arguments.input("--frames", a.frames, "folder where the frames of a capture lie, if elsewhere");
}

ScanProject project_in(const std::filesystem::path& path) {
  if (!is_octomap_log(path)) return read_scan_project(path);
  ScanProject project;
  for (const ListedScan& scan : list_log(path)) project.scans.push_back(scan.read());
  return project;
}

void run(const InfoArguments& a, Session& session) {
  const FileKind kind = file_kind(a.file);
  Figures& figures = session.figures;
  figures.text("file", "file", a.file.string());
  figures.text("kind", "kind", to_string(kind));
  switch (kind) {
    case FileKind::kRig:
      return describe(read_rig(a.file, RigParts::kCamera), figures);
    case FileKind::kScene:
      return describe(read_scene(a.file), figures);
    case FileKind::kCapture: {
      const auto frames = a.frames.empty() ? std::nullopt : std::optional(a.frames);
      return describe(read_capture(a.file, frames), figures);
    }
    case FileKind::kLog:
      return describe(StripeLogReader(a.file), figures);
    case FileKind::kProject:
      return describe(project_in(a.file), figures);
    case FileKind::kScan:
      return describe(read_scan(a.file), figures);
    case FileKind::kCloud:
      return describe(read_cloud(a.file), figures);
    case FileKind::kMesh:
      return describe(read_any_mesh(a.file), figures);
    case FileKind::kMap:
      return is_map_file(a.file) ? report_map_file(read_map_file(a.file), figures)
                                 : report_map(OccupancyMap::read(a.file), figures);
    case FileKind::kGrid:
      return report_grid(read_navigation_grid(a.file), figures);
  }
}

}  // namespace

Command info_command() {
  const auto a = std::make_shared<InfoArguments>();
  return {.name = "info",
          .summary = "say what a file is and whether it is sound",
          .description =
              "Reads a file that facula works with, checks it as the other commands would, and "
              "prints its figures; says what is wrong with it otherwise.",
          .examples = {"facula info data/rigs/head_fs1500.toml",
                       "facula info data/scenes/furnished_room.toml --json -"},
          .declare = [a](Arguments& arguments) { declare(arguments, *a); },
          .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
