// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/calibration_set_file.hpp>
#include <facula/acquire/calibrate/synthetic_set.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/covariance_block.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/calibrate_joint.hpp>
#include <facula/apps/commands/calibration_figures.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace facula {
namespace {

struct JointArguments {
  std::filesystem::path set;
  std::filesystem::path out;
  std::filesystem::path camera;
  JointOptions options;
};

void declare_common(Arguments& arguments, JointArguments& a) {
  arguments.input("SET", a.set, "a calibration set: its calibration.toml, or the folder with it");
  arguments.required();
  arguments.output("--out", a.out, "the rig that is written (.toml), with its covariance");
  arguments.required();
  arguments.number("--point-sigma-px",
                   a.options.point_sigma,
                   kPixels,
                   "noise of a board point along x and y, 0 = from the residuals");
  arguments.whole("--folds", a.options.folds, "parts of the views held out in turn, 0 = none");
}

void declare_joint(Arguments& arguments, JointArguments& a) {
  declare_common(arguments, a);
  arguments.input("--rig", a.camera, "a rig whose camera to start from; its other parts are kept");
  arguments.whole("--radial-terms", a.options.radial_terms, "how many of k1, k2, k3 to estimate");
  arguments.flag("--bow", a.options.bow, "estimate the bow of each sheet, too");
}

void declare_axis(Arguments& arguments, JointArguments& a) {
  declare_common(arguments, a);
  arguments.input("--rig", a.camera, "the rig with the calibrated camera; its sheets are kept");
  arguments.required();
}

/// The calibrated rig with what the set says nothing about as the known rig has it.
Rig with_parts_kept(Rig calibrated, const Rig& known) {
  Rig rig = known;
  rig.camera = calibrated.camera;
  rig.covariance = std::move(calibrated.covariance);
  for (LaserPlane& laser : calibrated.lasers) {
    const auto same = std::find_if(rig.lasers.begin(), rig.lasers.end(), [&](const LaserPlane& l) {
      return l.name == laser.name;
    });
    if (same != rig.lasers.end()) {
      *same = std::move(laser);
    } else {
      rig.lasers.push_back(std::move(laser));
    }
  }
  if (calibrated.axis.kind != AxisKind::kNone) rig.axis = calibrated.axis;
  return rig;
}

void run_joint(const JointArguments& a, Session& session) {
  check_output(a.out, {".toml"});
  const CalibrationSetFile file = read_calibration_set(a.set);
  JointOptions options = a.options;
  options.position_sigma = file.position_sigma;
  options.num_threads = session.num_threads;
  options.camera = file.camera;
  std::optional<Rig> known;
  if (!a.camera.empty()) known = read_rig(a.camera, RigParts::kCamera);
  if (known) options.camera = known->camera;
  JointCalibration result = calibrate_jointly(file.set, options);
  result.rig.name = a.out.stem().string();
  if (known) result.rig = with_parts_kept(std::move(result.rig), *known);
  write_rig(a.out, result.rig, RigParts::kCamera);
  report_calibration(result, session.figures);
  session.figures.text("out", "written", a.out.string());
}

/// The set without what only sheets need, and without views held by hand.
CalibrationSet axis_part(const CalibrationSet& set) {
  CalibrationSet part = set;
  part.lasers.clear();
  std::erase_if(part.views, [](const JointView& v) { return !v.position.has_value(); });
  for (JointView& view : part.views) view.lines.clear();
  require(set.axis != AxisKind::kNone && !part.views.empty(),
          "expected a set with an axis and views at positions of it, got none; name `axis` and the "
          "`positions` of the views");
  return part;
}

void run_axis(const JointArguments& a, Session& session) {
  check_output(a.out, {".toml"});
  Rig rig = read_rig(a.camera, RigParts::kCamera);
  const CalibrationSetFile file = read_calibration_set(a.set);
  JointOptions options = a.options;
  options.position_sigma = file.position_sigma;
  options.num_threads = session.num_threads;
  options.camera = rig.camera;
  options.fix_camera = true;
  const JointCalibration result = calibrate_jointly(axis_part(file.set), options);
  rig.axis = result.rig.axis;
  const RigCovariance& covariance = *result.rig.covariance;
  replace_covariance(rig, "axis.", covariance.parameters, covariance.matrix);
  write_rig(a.out, rig, RigParts::kCamera);
  report_calibration(result, session.figures);
  session.figures.note(
      "The camera was taken as exact: the axis' sigmas hold the noise of the board points only.");
  session.figures.text("out", "written", a.out.string());
}

struct ExampleArguments {
  std::filesystem::path rig;
  std::filesystem::path out;
  SyntheticSetOptions options;
  double span = 0;  ///< 0 = 60 degrees, or half the distance [rad or m]
  std::size_t seed = 1;
  bool overwrite = false;
};

void declare_example(Arguments& arguments, ExampleArguments& a) {
  arguments.input("--rig", a.rig, "the rig that sees the boards");
  arguments.required();
  arguments.output("--out", a.out, "folder of the set that is made");
  arguments.required();
  arguments.number("--distance-mm", a.options.distance, kMillimetres, "of the boards, about");
  arguments.number("--span-deg", a.span, kDegrees, "of the axis positions, 0 = 60");
  arguments.whole("--hand-views", a.options.hand_views, "boards held by hand");
  arguments.whole("--placements", a.options.placements, "boards put up for the axis");
  arguments.number("--noise-px", a.options.point_noise, kPixels, "of a board point along x and y");
  arguments.number("--second-size",
                   a.options.second_scale,
                   kPlainNumber,
                   "true size of a second board on the axis over what the set says, 1 = one board");
  arguments.number("--wrong-share", a.options.wrong_share, kPlainNumber, "of board points misread");
  arguments.whole("--seed", a.seed, "of the noise");
  arguments.flag("--overwrite", a.overwrite, "replace an earlier set in that folder");
}

void require_in_range(const ExampleArguments& a) {
  const SyntheticSetOptions& o = a.options;
  const auto need = [](bool good, const char* option, const char* range, double got) {
    require(good, option, ": expected ", range, ", got ", got);
  };
  const double span = a.span / kDegrees.factor;
  need(o.distance > 0 && o.distance < 1000, "--distance-mm", "0 to 1000000", 1000 * o.distance);
  need(span >= 0 && span <= 360, "--span-deg", "0 to 360", span);
  need(o.hand_views <= 1000, "--hand-views", "0 to 1000", o.hand_views);
  need(o.placements <= 1000, "--placements", "0 to 1000", o.placements);
  need(o.point_noise >= 0 && o.point_noise < 100, "--noise-px", "0 to 100", o.point_noise);
  need(o.second_scale > 0.1 && o.second_scale < 10, "--second-size", "0.1 to 10", o.second_scale);
  need(o.wrong_share >= 0 && o.wrong_share <= 1, "--wrong-share", "0 to 1", o.wrong_share);
}

void run_example(const ExampleArguments& a, Session& session) {
  const Rig rig = read_rig(a.rig);
  require_in_range(a);
  SyntheticSetOptions options = a.options;
  options.seed = a.seed;
  options.boards = options.second_scale == 1 ? 1 : 2;
  if (a.span > 0) options.span = a.span;
  if (rig.axis.kind == AxisKind::kLinear) options.span = 0.5 * options.distance;
  const CalibrationSet set = synthesize_calibration_set(rig, options);
  OutputFolder folder(a.out, "calibration.toml", a.overwrite);
  write_calibration_set(folder.temporary_path(), set);
  folder.commit();
  std::size_t lines = 0;
  for (const JointView& view : set.views) lines += view.lines.size();
  session.figures.count("views", "views", set.views.size());
  session.figures.count("lines", "laser lines on boards", lines);
  session.figures.text("out", "written", a.out.string());
}

}  // namespace

Command calibrate_joint_command() {
  const auto a = std::make_shared<JointArguments>();
  return {
      .name = "calibrate joint",
      .summary = "camera, sheets and axis in one fit",
      .description =
          "Fits camera, distortion, all laser sheets, the axis and the poses of the boards to "
          "all views at once, robustly, and writes a rig with its covariance. The figures that "
          "count are those held out: each view as the fit without it foretells it, wrong points "
          "included. Says what the views cannot decide and which boards contradict each other.",
      .examples =
          {"facula calibrate example --rig data/rigs/ciclop_turntable.toml --out set",
           "facula calibrate joint set --out rig.toml",
           "facula calibrate example --rig data/rigs/ciclop_turntable.toml --second-size 1.02 "
           "--out contradiction",
           "facula calibrate joint contradiction --out contradiction.toml"},
      .declare = [a](Arguments& arguments) { declare_joint(arguments, *a); },
      .run = [a](Session& session) { run_joint(*a, session); }};
}

Command calibrate_axis_command() {
  const auto a = std::make_shared<JointArguments>();
  return {
      .name = "calibrate axis",
      .summary = "the axis from boards at its positions",
      .description =
          "Finds the axis of a turntable, a pan head or a linear stage from views of a board at "
          "several of its positions, with the camera of a rig taken as exact. Sheets of the rig "
          "are kept. `calibrate joint` does the same with everything else in one fit and is the "
          "better choice where the laser line is on the boards, too.",
      .examples = {"facula calibrate example --rig data/rigs/head_fs1500.toml --distance-mm 500 "
                   "--span-deg 50 --out set",
                   "facula calibrate axis set --rig data/rigs/head_fs1500.toml --out rig.toml"},
      .declare = [a](Arguments& arguments) { declare_axis(arguments, *a); },
      .run = [a](Session& session) { run_axis(*a, session); }};
}

Command calibrate_example_command() {
  const auto a = std::make_shared<ExampleArguments>();
  return {
      .name = "calibrate example",
      .summary = "a calibration set by simulation",
      .description =
          "Writes a calibration set as a rig would see it: corners of boards held by hand and of "
          "boards at positions of the axis, laser lines on them, with noise. To try `calibrate "
          "joint` and `calibrate axis`, and to plan how many views a wanted accuracy takes.",
      .examples = {"facula calibrate example --rig data/rigs/ciclop_turntable.toml --out set"},
      .declare = [a](Arguments& arguments) { declare_example(arguments, *a); },
      .run = [a](Session& session) { run_example(*a, session); }};
}

}  // namespace facula
