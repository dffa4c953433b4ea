// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/apps/commands/axis_programme.hpp>
#include <facula/apps/commands/demo/recorded_scan.hpp>
#include <facula/reconstruct/filter/scan_filters.hpp>

namespace facula {
namespace {

void simulate(const RecordingPlan& plan,
              const RecordedScan& scan,
              const DemoSettings& settings,
              Session& session) {
  SimulateOptions options = options_for(*plan.rig);
  options.seed = settings.seed;
  options.num_threads = settings.num_threads;
  options.progress = session.progress("simulating " + plan.name);
  AxisProgramme programme;
  programme.step_angle = plan.step;
  std::filesystem::create_directories(scan.capture);
  simulate_capture(scan.capture,
                   *plan.scene,
                   *plan.rig,
                   {plan.world_from_scan, axis_positions(programme, plan.rig->axis)},
                   options);
}

}  // namespace

RecordedScan record(const RecordingPlan& plan, const DemoSettings& settings, Session& session) {
  RecordedScan scan;
  scan.name = plan.name;
  scan.capture = settings.folder / "captures" / plan.name;
  scan.true_world_from_scan = plan.world_from_scan;
  simulate(plan, scan, settings, session);
  scan.truth = read_scan(scan.capture / "truth.pcd");
  scan.extracted =
      extract_scan(read_capture(scan.capture),
                   {settings.num_threads, session.progress("reading stripes of " + plan.name)});
  scan.clean = scan.extracted.scan;
  scan.mixed_removed = remove_mixed_points(scan.clean);
  return scan;
}

}  // namespace facula
