// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/axis_positions.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/core/toml_text.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/axis_errors.hpp>
#include <facula/acquire/simulate/frame_renderer.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <locale>
#include <mutex>
#include <string>

namespace facula {
namespace {

constexpr const char* kLit = "frames";
constexpr const char* kDark = "background";
constexpr const char* kDarkAfter = "background_after";
constexpr double kFarthest = 1e6;  // [m], farther the ray tracer's floats know no directions

// "0012.png"; all names of a run have the same length, so that they sort by number.
std::string frame_name(std::size_t frame, std::size_t count) {
  const std::size_t digits = std::max<std::size_t>(4, std::to_string(count).size());
  const std::string number = std::to_string(frame);
  return std::string(digits - number.size(), '0') + number + ".png";
}

bool is_frame_name(const std::filesystem::path& path) {
  const std::string stem = path.stem().string();
  return path.extension() == ".png" && stem.size() >= 4 &&
         std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isdigit(c); });
}

// A folder without the frames of an earlier run, which would be counted in.
void prepare_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  require(!error && std::filesystem::is_directory(folder),
          "the folder '",
          folder.string(),
          "' cannot be made; check the path and its rights");
  std::vector<std::filesystem::path> old;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file() && is_frame_name(entry.path())) old.push_back(entry.path());
  }
  for (const std::filesystem::path& path : old) std::filesystem::remove(path);
}

// Median width of the line in the image, for surfaces square to the camera, pixel area and blur
// included.
double expected_line_sigma(const PolarScan& truth, const Rig& rig, const SimulateOptions& options) {
  const LaserFan fan = laser_fan(rig, options);
  const double focal_length =
      rig.stripe_direction == StripeDirection::kPerRow ? rig.camera.fx : rig.camera.fy;
  std::vector<double> widths;
  for (int col = 0; col < truth.cols; ++col) {
    const RigidTransform camera_from_scan =
        rig.axis.scan_from_camera_at(truth.axis_position[static_cast<std::size_t>(col)]).inverse();
    for (int row = 0; row < truth.rows; ++row) {
      const std::size_t cell = truth.index(row, col);
      if (truth.valid[cell] == 0) continue;
      const Eigen::Vector3d x = camera_from_scan * truth.point[cell].cast<double>();
      widths.push_back(std::hypot(line_sigma(fan, focal_length, x), options.lens.blur));
    }
  }
  if (widths.empty()) return 2;
  return std::clamp(median(widths), 0.5, 10.0);
}

// The channel that shows the laser best.
const char* channel_for(const SimulateOptions& options) {
  if (!options.colour_frames || options.laser_colour == LaserColour::kInfrared) return "grey";
  return options.laser_colour == LaserColour::kRed ? "red" : "green";
}

/// The scene's z points up: a head that pans about it is plumb.
ScanStand stand_of(const Rig& rig, const RigidTransform& world_from_scan) {
  const Eigen::Vector3d axis = world_from_scan.rotation * Eigen::Vector3d::UnitZ();
  const bool plumb = axis.head<2>().norm() < 1e-9 && axis.z() > 0;
  return rig.axis.kind == AxisKind::kPan && plumb ? ScanStand::kUpright : ScanStand::kFree;
}

void write_capture(const std::filesystem::path& folder,
                   const SimulateOptions& options,
                   const Rig& rig,
                   const RigidTransform& world_from_scan,
                   double line_sigma) {
  AtomicFile file(folder / "capture.toml");
  std::ostream& out = file.stream();
  out.imbue(std::locale::classic());
  out.precision(17);
  const Eigen::Vector3d t = world_from_scan.translation * 1000;
  const Eigen::Quaterniond& q = world_from_scan.rotation;
  out << "rig = \"rig.toml\"\nlaser = " << toml_quoted(rig.lasers[options.laser].name) << "\n";
  const ScanStand stand = stand_of(rig, world_from_scan);
  if (stand != ScanStand::kFree) out << "stand = " << toml_quoted(to_string(stand)) << "\n";
  out << "\n[frames]\non = \"" << kLit << "/*.png\"\n";
  if (options.background_frames) out << "off = \"" << kDark << "/*.png\"\n";
  out << "\n[positions]\ncsv = \"positions.csv\"\n"
      << "\n[stripe]\nchannel = \"" << channel_for(options)
      << "\"\nsigma_px = " << std::round(line_sigma * 100) / 100
      << "\n\n[pose]  # world_from_scan\n"
      << "translation_mm = [" << t.x() << ", " << t.y() << ", " << t.z() << "]\n"
      << "quaternion_xyzw = [" << q.x() << ", " << q.y() << ", " << q.z() << ", " << q.w() << "]\n";
  file.commit();
}

// Where the frames of a run are taken.
struct FramePoses {
  RigidTransform world_from_scan;
  const Axis& axis;
  std::vector<double> positions;  // of the lit frames
  const SimulateOptions& options;

  // While the axis moves, dark frames are taken on its way.
  RigidTransform world_from_camera(const Exposure& exposure) const {
    double position = positions[exposure.step];
    if (!exposure.laser_on) {
      const double way = options.axis_errors.speed * options.timing.frame_interval;
      position += exposure.after ? way : -way;
    }
    return world_from_scan * axis.scan_from_camera_at(position);
  }
};

void write_exposures(const std::filesystem::path& folder,
                     const FrameRenderer& renderer,
                     const FramePoses& poses,
                     std::size_t i) {
  const std::string name = frame_name(i, poses.positions.size());
  const auto write = [&](const char* place, const Exposure& exposure) {
    const Image8 frame = renderer.render(poses.world_from_camera(exposure), exposure);
    write_image(folder / place / name, frame.view());
  };
  write(kLit, {.laser_on = true, .step = i});
  if (poses.options.background_frames) write(kDark, {.laser_on = false, .step = i});
  if (poses.options.second_background) {
    write(kDarkAfter, {.laser_on = false, .step = i, .after = true});
  }
}

// One frame after the other goes to the disk: memory does not grow with their number.
void write_frames(const std::filesystem::path& folder,
                  const FrameRenderer& renderer,
                  const FramePoses& poses) {
  const std::size_t count = poses.positions.size();
  std::mutex counting;
  std::size_t done = 0;
  const auto render = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      write_exposures(folder, renderer, poses, i);
      const std::lock_guard lock(counting);
      ++done;
      if (poses.options.progress) poses.options.progress(done, count);
    }
  };
  parallel_for(count, render, {.num_threads = poses.options.num_threads, .chunk = 1});
}

void check_poses(const FramePoses& poses) {
  for (std::size_t i = 0; i < poses.positions.size(); ++i) {
    const double distance = poses.world_from_camera({.step = i}).translation.norm();
    require(distance < kFarthest,
            "expected the camera within ",
            kFarthest,
            " m of the scene's origin, got ",
            distance,
            " m; check the position of the head, the rig's axis and its programme");
  }
}

void prepare_folders(const std::filesystem::path& folder, const SimulateOptions& options) {
  prepare_folder(folder / kLit);
  if (options.background_frames) prepare_folder(folder / kDark);
  if (options.second_background) prepare_folder(folder / kDarkAfter);
}

}  // namespace

void simulate_capture(const std::filesystem::path& folder,
                      const Scene& scene,
                      const Rig& rig,
                      const SimulatedRun& run,
                      const SimulateOptions& options) {
  require(!run.positions.empty(), "a simulated run needs at least one axis position, but has none");
  const FrameRenderer renderer(scene, rig, options);
  const FramePoses poses{run.world_from_scan,
                         rig.axis,
                         travelled_positions(run.positions, options.axis_errors, options.seed),
                         options};
  check_poses(poses);
  prepare_folders(folder, options);
  write_frames(folder, renderer, poses);
  const PolarScan truth = true_scan(scene, rig, run.world_from_scan, poses.positions, options);
  write_scan(folder / "truth.pcd", truth);
  write_rig(folder / "rig.toml", rig);
  write_axis_positions(folder / "positions.csv", run.positions, rig.axis.kind);
  const double line_sigma = expected_line_sigma(truth, rig, options);
  write_capture(folder, options, rig, run.world_from_scan, line_sigma);
}

}  // namespace facula
