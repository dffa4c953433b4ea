// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/demo.hpp>
#include <facula/apps/commands/demo/demo_report.hpp>
#include <facula/apps/commands/demo/object_demo.hpp>
#include <facula/apps/commands/demo/room_demo.hpp>

#include <chrono>
#include <memory>

namespace facula {
namespace {

struct DemoArguments {
  std::filesystem::path out = "demo";
  bool quick = false;
  std::size_t seed = 1;
};

void declare(Arguments& arguments, DemoArguments& a) {
  arguments.output("--out", a.out, "folder of the results; an earlier demo there is replaced");
  arguments.flag("--quick", a.quick, "fewer frames: coarser results in less than half the time");
  arguments.whole("--seed", a.seed, "of the noise and the rough poses");
}

DemoSettings settings_of(const DemoArguments& a, const Session& session) {
  DemoSettings settings;
  settings.seed = a.seed;
  settings.num_threads = session.num_threads;
  if (a.quick) {
    settings.room_step = 3 * kDegrees.factor;
    settings.object_step = 4 * kDegrees.factor;
  }
  return settings;
}

void write_figures(const std::filesystem::path& path, const Figures& figures) {
  AtomicFile file(path);
  file.stream() << figures.json();
  file.commit();
}

void run(const DemoArguments& a, Session& session) {
  const auto start = std::chrono::steady_clock::now();
  OutputFolder folder(a.out, "demo.json", true);
  DemoSettings settings = settings_of(a, session);
  settings.folder = folder.temporary_path();
  std::filesystem::create_directory(settings.folder / "scans");
  const RoomDemo room = run_room_demo(settings, session);
  const ObjectDemo object = run_object_demo(settings, session);
  write_demo_report(room, object, settings, session);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  session.figures.number("elapsed_s", "time", elapsed.count(), 1);
  session.figures.text("results", "results", a.out.string());
  session.figures.note("Results are in " + a.out.string() +
                       "/: open report.html; pictures/, captures/, scans/, poses.toml, planes.csv, "
                       "room_mesh.ply, object_mesh.ply, map.bt, map.ot, map.yaml, demo.json.");
  write_figures(settings.folder / "demo.json", session.figures);
  folder.commit();
}

}  // namespace

Command demo_command() {
  const auto a = std::make_shared<DemoArguments>();
  return {
      .name = "demo",
      .summary = "the whole road on simulated scenes, checked against the truth",
      .description =
          "Simulates a furnished room seen from three places and an object on a turntable, then "
          "extracts, filters, registers (from rough poses 100 mm and 3 deg off), measures "
          "planes, meshes, maps and reports, and prints for every step how far it is from the "
          "truth, which the scenes define exactly.",
      .examples = {"facula demo --quick"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
