// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/posed_scans.hpp>
#include <facula/apps/commands/register.hpp>
#include <facula/apps/commands/register_figures.hpp>
#include <facula/reconstruct/register/register_scans.hpp>

#include <memory>
#include <string>
#include <vector>

namespace facula {
namespace {

struct RegisterArguments {
  std::vector<std::filesystem::path> scans;
  std::filesystem::path out;
  std::string start = "auto";
  std::string motion = "auto";
  RegisterScansOptions options;
};

void declare(Arguments& arguments, RegisterArguments& a) {
  arguments.inputs("SCANS",
                   a.scans,
                   "poses.toml, a Stanford .conf, a folder of 3DTK scans, or two and more scan "
                   "files, in any order");
  arguments.required();
  arguments.output("--out", a.out, "the poses found (.toml), which names the scans; also -o");
  arguments.required();
  arguments.choice("--start",
                   a.start,
                   {"auto", "given", "nothing"},
                   "from the poses the files hold or from nothing; auto: from the poses where they "
                   "differ");
  arguments.choice("--motion",
                   a.motion,
                   {"auto", "free", "upright", "table"},
                   "upright: heads that pan about a plumb axis; table: an object that turns or is "
                   "moved on a table, and keeps its height; auto: what all the scans' captures say "
                   "of their stand, else free");
  arguments.vector(
      "--axis", a.options.motion.axis, kPlainNumber, "of that motion, in the frame of every scan");
  arguments.number("--voxel-mm",
                   a.options.pyramid.finest_voxel,
                   kMillimetres,
                   "scans are thinned to this first, 0 = by their own sampling");
  arguments.number("--max-distance-mm",
                   a.options.refinement.max_distance,
                   kMillimetres,
                   "how far surfaces lie apart by the poses given, 0 = by the voxel");
  arguments.number("--min-overlap",
                   a.options.min_overlap,
                   kPlainNumber,
                   "share that two scans must have in common to be registered with each other");
  arguments.whole("--seed", a.options.global.seed, "of the search from nothing");
}

RegisterScansOptions options_of(const RegisterArguments& a,
                                const ScanProject& project,
                                const Session& session) {
  RegisterScansOptions options = a.options;
  options.start = a.start == "given"     ? ScanStart::kGiven
                  : a.start == "nothing" ? ScanStart::kNothing
                                         : ScanStart::kAuto;
  options.motion.kind = stand_from_name(a.motion).value_or(project.stand());
  options.num_threads = session.num_threads;
  options.progress = session.progress("registering scans");
  return options;
}

/// One sentence when no scan could be joined with another.
void require_any_placed(const ScanProject& project, const RegisterScansResult& result) {
  if (result.placed >= 2) return;
  std::string reasons;
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    if (!result.scans[i].placed) {
      reasons +=
          (reasons.empty() ? "'" : "; '") + project.scans[i].name + "': " + result.scans[i].reason;
    }
  }
  fail("no scan could be placed; ", reasons);
}

void report_motion(const RegisterArguments& a, ScanStand kind, Figures& figures) {
  figures.text("motion", "motion", to_string(kind));
  if (a.motion == "auto" && kind != ScanStand::kFree) {
    figures.note(
        "The captures of all scans say how they stand to each other (motion); --motion free lets "
        "the scans lie as they may.");
  }
}

void run(const RegisterArguments& a, Session& session) {
  check_output(a.out, {".toml"});
  ScanProject project = read_posed_scans(a.scans).project;
  std::vector<RigidTransform> before;
  for (const PosedCloud& scan : project.scans) before.push_back(scan.world_from_scan);
  const RegisterScansOptions options = options_of(a, project, session);
  const RegisterScansResult result = register_scans(project, options);
  require_any_placed(project, result);
  ScanProject placed;
  for (std::size_t i = 0; i < result.scans.size(); ++i) {
    if (result.scans[i].placed) placed.scans.push_back(project.scans[i]);
  }
  write_poses(a.out, placed);
  report_registration(project, before, result, session.figures);
  report_motion(a, options.motion.kind, session.figures);
  session.figures.text("out", "written", a.out.string());
}

}  // namespace

Command register_command() {
  const auto a = std::make_shared<RegisterArguments>();
  const std::string simulate =
      "facula simulate data/scenes/furnished_room.toml --rig data/rigs/head_fs1500.toml "
      "--step-deg 6 ";
  return {
      .name = "register",
      .summary = "move scans onto each other",
      .description =
          "Finds the poses of scans, in any order and from nothing: registers every pair, joins "
          "the pairs in a graph that gives up those which contradict the others, registers all "
          "that overlap once more from there, and writes the poses of the scans that were placed. "
          "A scan that cannot be placed is refused by name. Rough poses that the files hold are "
          "used instead of the search. docs/registration.md explains the figures.",
      .examples = {simulate + "--position-mm -1500 -300 1100 --out here",
                   simulate + "--position-mm 200 800 1100 --out there",
                   "facula extract here --out here.pcd",
                   "facula extract there --out there.pcd",
                   "facula register here.pcd there.pcd --voxel-mm 100 --out poses.toml"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
