// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/conditions_file.hpp>
#include <facula/acquire/simulate/simulate.hpp>
#include <facula/apps/cli/output_path.hpp>
#include <facula/apps/commands/axis_programme.hpp>
#include <facula/apps/commands/simulate.hpp>

#include <memory>

namespace facula {
namespace {

/// Light and sensor as typed; what is not given is as the conditions say, or else suits the rig.
struct LightOverrides {
  std::size_t laser = 0;                    ///< [1]
  std::filesystem::path conditions;         ///< empty: none
  std::optional<double> laser_peak;         ///< [DN]
  std::optional<double> line_half_width;    ///< [m]
  std::optional<double> exposure_falloff;   ///< [1]
  std::optional<double> ambient;            ///< [DN]
  std::optional<double> read_noise;         ///< [DN]
  std::optional<double> shot_noise;         ///< [DN]
  std::optional<double> axis_noise_angle;   ///< [rad]
  std::optional<double> axis_noise_length;  ///< [m]
};

struct SimulateArguments {
  std::filesystem::path scene;
  std::filesystem::path rig;
  std::filesystem::path out;
  bool overwrite = false;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the head or table [m]
  double yaw = 0;                                      ///< of the head or table [rad]
  AxisProgramme programme;
  bool background = false;
  bool second_background = false;
  std::size_t seed = 1;
  LightOverrides light;
};

void declare_light(Arguments& arguments, LightOverrides& o) {
  arguments.whole("--laser", o.laser, "which laser plane of the rig is lit, the first is 0");
  arguments.input("--conditions",
                  o.conditions,
                  "light, lens, speckle, sensor, and axis errors (conditions.toml)");
  arguments.number("--laser-peak-dn",
                   o.laser_peak,
                   kGreyLevels,
                   "signal of the line on a white wall 1 m away; chosen for the rig if not given");
  arguments.number("--line-half-width-mm",
                   o.line_half_width,
                   kMillimetres,
                   "half width (1 sigma) of the line at the laser; chosen for the rig");
  arguments.number("--exposure-falloff",
                   o.exposure_falloff,
                   kPlainNumber,
                   "power of (1 m / distance) that the light follows; chosen for the rig");
  arguments.number("--ambient-dn", o.ambient, kGreyLevels, "signal of a white wall in room light");
  arguments.number("--read-noise-dn", o.read_noise, kGreyLevels, "noise of a dark pixel, 1 sigma");
  arguments.number("--shot-noise-dn", o.shot_noise, kGreyLevels, "variance per DN of signal");
  arguments.number("--axis-noise-deg",
                   o.axis_noise_angle,
                   kDegrees,
                   "position error of a turning axis, 1 sigma");
  arguments.number("--axis-noise-mm",
                   o.axis_noise_length,
                   kMillimetres,
                   "position error of a linear axis, 1 sigma");
}

void override_with(const std::optional<double>& typed, double& value) {
  if (typed) value = *typed;
}

SimulateOptions light_for(const Rig& rig, const LightOverrides& o) {
  SimulateOptions options = options_for(rig);
  if (!o.conditions.empty()) options = read_conditions(o.conditions, rig, options);
  options.laser = o.laser;
  override_with(o.ambient, options.ambient);
  override_with(o.read_noise, options.read_noise);
  override_with(o.shot_noise, options.shot_noise);
  override_with(rig.axis.is_revolute() ? o.axis_noise_angle : o.axis_noise_length,
                options.axis_errors.noise);
  override_with(o.laser_peak, options.laser_peak);
  override_with(o.line_half_width, options.line_half_width);
  override_with(o.exposure_falloff, options.exposure_falloff);
  return options;
}

void declare(Arguments& arguments, SimulateArguments& a) {
  arguments.input("SCENE.toml", a.scene, "the scene: boxes, rooms, spheres, cylinders, meshes");
  arguments.required();
  arguments.input("--rig", a.rig, "the scanner: camera, laser planes, axis (rig.toml)");
  arguments.required();
  arguments.output("--out", a.out, "folder of the capture that is made");
  arguments.required();
  arguments.flag("--overwrite", a.overwrite, "replace an earlier capture in that folder");
  arguments.vector("--position-mm", a.position, kMillimetres, "where the head (or table) stands");
  arguments.number("--yaw-deg", a.yaw, kDegrees, "how the head (or table) is turned about z");
  declare_axis_programme(arguments, a.programme);
  arguments.flag("--background", a.background, "also take a frame, laser off, before each");
  arguments.flag("--second-background", a.second_background, "and another one after each");
  arguments.whole("--seed", a.seed, "of the noise");
  declare_light(arguments, a.light);
}

RigidTransform pose_of(const SimulateArguments& a) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(a.yaw, Eigen::Vector3d::UnitZ())), a.position};
}

void run(const SimulateArguments& a, Session& session) {
  const Scene scene = read_scene(a.scene);
  const Rig rig = read_rig(a.rig);
  const SimulatedRun simulated{pose_of(a), axis_positions(a.programme, rig.axis)};
  SimulateOptions options = light_for(rig, a.light);
  options.background_frames = a.background || a.second_background;
  options.second_background = a.second_background;
  options.seed = a.seed;
  options.num_threads = session.num_threads;
  options.check();
  OutputFolder folder(a.out, "capture.toml", a.overwrite);
  options.progress = session.progress("simulating frames");
  simulate_capture(folder.temporary_path(), scene, rig, simulated, options);
  folder.commit();
  session.figures.text("out", "capture", a.out.string());
  session.figures.text("rig", "rig", rig.name);
  session.figures.count("objects", "objects in the scene", scene.objects().size());
  session.figures.count("frames", "frames", simulated.positions.size());
  session.figures.count(
      "image_width_px", "image width", static_cast<std::size_t>(rig.camera.width));
  session.figures.count(
      "image_height_px", "image height", static_cast<std::size_t>(rig.camera.height));
}

}  // namespace

Command simulate_command() {
  const auto a = std::make_shared<SimulateArguments>();
  return {
      .name = "simulate",
      .summary = "record a simulated scan of a scene",
      .description =
          "Traces rays through a scene and writes what the camera of a line-laser scanner would "
          "have recorded: capture.toml, rig.toml, frames, and truth.pcd with the true points. "
          "The same seed gives the same frames.",
      .examples = {"facula simulate data/scenes/furnished_room.toml --rig "
                   "data/rigs/head_fs1500.toml --from-deg 0 --to-deg 20 --step-deg 2 "
                   "--position-mm -1500 -300 1100 --out room",
                   "facula simulate data/scenes/turntable_object.toml --rig "
                   "data/rigs/ciclop_turntable.toml --from-deg 0 --to-deg 330 --step-deg 30 "
                   "--background --out object",
                   "facula simulate data/scenes/interference.toml --rig "
                   "data/rigs/head_fs760.toml --conditions data/conditions/lit_room.toml "
                   "--from-deg -10 --to-deg 10 --step-deg 10 --second-background --out lit"},
      .declare = [a](Arguments& arguments) { declare(arguments, *a); },
      .run = [a](Session& session) { run(*a, session); }};
}

}  // namespace facula
