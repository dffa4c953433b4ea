// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/apps/commands/demo/demo_report.hpp>
#include <facula/apps/commands/report_sections.hpp>
#include <facula/apps/report/report_pictures.hpp>
#include <facula/map/navigation_grid.hpp>

#include <utility>

namespace facula {
namespace {

/// Every figure of the demo against the truth, step by step.
ReportSection truth_section(const Figures& figures) {
  ReportSection section{"Against the truth", "", {}, {}};
  section.text = "The scenes are known exactly, so every step's error is known as well.";
  for (const Figures::Part& part : figures.parts()) {
    ReportTable lines = figure_table(part.title, *part.figures);
    if (!lines.rows.empty()) section.tables.push_back(std::move(lines));
    for (ReportTable& table : report_tables(part.title, *part.figures)) {
      section.tables.push_back(std::move(table));
    }
  }
  return section;
}

}  // namespace

void write_demo_report(const RoomDemo& room,
                       const ObjectDemo& object,
                       const DemoSettings& settings,
                       Session& session) {
  session.step("drawing the report", 1, 1);
  std::vector<RigidTransform> poses;
  for (const PosedCloud& scan : room.project.scans) poses.push_back(scan.world_from_scan);
  Report report;
  report.title = "Facula demo: a furnished room and an object on a turntable";
  report.sections.push_back(truth_section(session.figures));
  report.sections.push_back(capture_section(read_capture(room.scans.front().capture)));
  report.sections.push_back(scan_section("room_1", room.scans.front().extracted.scan));
  report.sections.push_back(project_section(room.project));
  report.sections.push_back(cloud_section("The registered room", room.planes_cloud, room.planes));
  report.sections.push_back(mesh_section("of the room", room.mesh, settings.num_threads));
  report.sections.push_back(map_section("of the room", room.map, poses));
  report.sections.push_back(grid_section("of the room", navigation_grid(room.map), poses));
  report.sections.push_back(capture_section(read_capture(object.scan.capture)));
  report.sections.push_back(scan_section("of the object", object.scan.clean));
  report.sections.push_back(mesh_section("of the object", object.mesh, settings.num_threads));
  write_html_report(settings.folder / "report.html", report);
  write_report_pictures(settings.folder / "pictures", report);
  session.end_steps();
}

}  // namespace facula
