// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/apps/cli/file_kind.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/map_report.hpp>
#include <facula/apps/commands/measure_compare.hpp>
#include <facula/apps/commands/path_table.hpp>
#include <facula/apps/commands/plane_search.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/apps/commands/report.hpp>
#include <facula/apps/commands/report_sections.hpp>
#include <facula/apps/report/report_pictures.hpp>
#include <facula/reconstruct/mesh/mesh_exchange.hpp>

#include <memory>
#include <optional>
#include <utility>

namespace facula {
namespace {

struct ReportArguments {
  std::filesystem::path out;
  std::filesystem::path capture;
  std::filesystem::path frames;
  std::vector<std::filesystem::path> scans;
  std::filesystem::path mesh;
  std::filesystem::path map;
  bool next_scans = false;
  std::filesystem::path path;
  std::filesystem::path grid;
  std::filesystem::path project;
  std::filesystem::path pictures;
  std::optional<double> plane_inlier;
  std::filesystem::path compare;
  std::filesystem::path reference;
};

void declare(Arguments& arguments, ReportArguments& a) {
  arguments.output("--out", a.out, "the page (.html)");
  arguments.required();
  arguments.input("--capture", a.capture, "a capture: the stripe over a few frames");
  arguments.input("--frames", a.frames, "folder where its frames lie, if not beside it");
  arguments.inputs("--scan", a.scans, "a scan: range image and planes");
  arguments.input("--project", a.project, "poses.toml: all scans together, planes, poses");
  arguments.number("--plane-inlier-mm",
                   a.plane_inlier,
                   kMillimetres,
                   "farthest from a plane that a point of it lies; more than its flatness");
  arguments.input("--mesh", a.mesh, "a mesh: three views");
  arguments.input("--compare", a.compare, "points to show in the colours of their deviations");
  arguments.input("--reference", a.reference, "the mesh or cloud that --compare deviates from");
  arguments.input("--map", a.map, "an occupancy map (.bt, .ot, .fmap) from above");
  arguments.flag("--next-scans", a.next_scans, "of --map also: its floor and where to scan next");
  arguments.input("--path", a.path, "a path (.csv of 'map plan') over the map");
  arguments.output("--pictures", a.pictures, "folder that also gets every picture as a .png");
  arguments.input("--grid", a.grid, "a navigation grid (.yaml) from above");
}

ReportSection planes_section(const std::string& heading,
                             const ScanProject& project,
                             std::optional<double> inlier_distance,
                             int num_threads) {
  PlaneExtractionOptions options;
  options.inlier_distance = inlier_distance;
  options.num_threads = num_threads;
  const FoundPlanes found = planes_of(project, options);
  return cloud_section(heading, found.cloud, found.planes, {found.inlier_distance, found.widened});
}

void add_scans(const ReportArguments& a, int num_threads, Report& report) {
  for (const auto& path : a.scans) {
    const std::string name = path.filename().string();
    if (file_kind(path) == FileKind::kScan) {
      report.sections.push_back(scan_section(name, read_scan(path)));
    }
    report.sections.push_back(planes_section(
        "Planes in " + name, read_posed_scans({path}).project, a.plane_inlier, num_threads));
  }
}

void add_comparison(const ReportArguments& a, int num_threads, Report& report) {
  require(a.compare.empty() == a.reference.empty(),
          "expected --compare and --reference together, got one of them; points deviate from "
          "something");
  if (a.compare.empty()) return;
  const PointCloud cloud = read_posed_scans({a.compare}, false).project.fused();
  report.sections.push_back(comparison_section(
      a.compare.filename().string() + " against " + a.reference.filename().string(),
      cloud,
      deviations_from_file(cloud.points, a.reference, {.num_threads = num_threads})));
}

Report make_report(const ReportArguments& a, Session& session) {
  constexpr std::size_t kSteps = 6;
  Report report;
  report.title = "Facula report";
  std::vector<RigidTransform> poses;
  session.step("capture", 1, kSteps);
  if (!a.capture.empty()) {
    const auto frames = a.frames.empty() ? std::nullopt : std::optional(a.frames);
    report.sections.push_back(capture_section(read_capture(a.capture, frames)));
  }
  session.step("scans", 2, kSteps);
  add_scans(a, session.num_threads, report);
  session.step("project", 3, kSteps);
  if (!a.project.empty()) {
    const ScanProject project = read_posed_scans({a.project}).project;
    for (const PosedCloud& scan : project.scans) poses.push_back(scan.world_from_scan);
    report.sections.push_back(project_section(project));
    report.sections.push_back(
        planes_section("All scans together", project, a.plane_inlier, session.num_threads));
  }
  session.step("mesh", 4, kSteps);
  if (!a.mesh.empty()) {
    report.sections.push_back(
        mesh_section(a.mesh.filename().string(), read_any_mesh(a.mesh), session.num_threads));
  }
  add_comparison(a, session.num_threads, report);
  session.step("maps", 5, kSteps);
  if (!a.map.empty()) {
    const std::string name = a.map.filename().string();
    const OccupancyMap map = OccupancyMap::read(a.map);
    report.sections.push_back(map_section(name, map, poses));
    if (a.next_scans) {
      report.sections.push_back(next_scans_section(name, map, session.num_threads));
    }
    if (!a.path.empty()) {
      report.sections.push_back(
          path_section(a.path.filename().string(), map, read_path_table(a.path)));
    }
  }
  if (!a.grid.empty()) {
    report.sections.push_back(
        grid_section(a.grid.filename().string(), read_navigation_grid(a.grid), poses));
  }
  return report;
}

void run(const ReportArguments& a, Session& session) {
  check_output(a.out, {".html", ".htm"});
  require(a.path.empty() || !a.map.empty(),
          "expected --map beside --path, got none; give the map the path was planned in");
  require(!a.next_scans || !a.map.empty(), "--next-scans needs --map, the map to scan on from");
  const Report report = make_report(a, session);
  require(!report.sections.empty(),
          "expected something to show, got none; give --capture, --scan, "
          "--project, --mesh, --compare, --map or --grid");
  write_html_report(a.out, report);
  if (!a.pictures.empty()) write_report_pictures(a.pictures, report);
  std::size_t pictures = 0;
  std::size_t tables = 0;
  for (const ReportSection& section : report.sections) {
    pictures += section.pictures.size();
    tables += section.tables.size();
  }
  session.figures.text("out", "written", a.out.string());
  session.figures.count("sections", "sections", report.sections.size());
  session.figures.count("pictures", "pictures", pictures);
  session.figures.count("tables", "tables", tables);
}

}  // namespace

Command report_command() {
  const auto a = std::make_shared<ReportArguments>();
  return {
      .name = "report",
      .summary = "show results on one HTML page",
      .description =
          "Puts what other commands have made onto one page with pictures and tables that "
          "needs no other file: the found stripe over a few frames, range images, deviations "
          "from planes, maps from above, meshes from three sides.",
      .examples = {"facula simulate data/scenes/turntable_object.toml --rig "
                   "data/rigs/ciclop_turntable.toml --step-deg 15 --out object",
                   "facula extract object --out object.pcd",
                   "facula mesh object.pcd --out object.ply",
                   "facula report --capture object --scan object.pcd --mesh object.ply --compare "
                   "object.pcd --reference object.ply --out report.html"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
