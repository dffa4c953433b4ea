// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/axis_positions.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/core/scan_file.hpp>
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/frame_renderer.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iomanip>
#include <limits>
#include <locale>
#include <mutex>
#include <string>

namespace facula {
namespace {

constexpr std::uint64_t kAxisStream = std::numeric_limits<std::uint64_t>::max();

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

// Where the axis really goes.
std::vector<double> travelled(const std::vector<double>& programme,
                              const SimulateOptions& options) {
  std::vector<double> positions = programme;
  if (options.axis_noise == 0) return positions;
  Random random(options.seed, kAxisStream);
  for (double& position : positions) position += options.axis_noise * random.normal();
  return positions;
}

// Median width of the line in the image, for surfaces square to the camera, pixel area included.
double expected_line_sigma(const PolarScan& truth, const Rig& rig, const LaserFan& fan) {
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
      const double blur = focal_length * fan.half_width((x - fan.origin).norm()) / x.z();
      widths.push_back(std::sqrt(blur * blur + 1.0 / 12));
    }
  }
  if (widths.empty()) return 2;
  return std::clamp(median(widths), 0.5, 10.0);
}

void write_capture(const std::filesystem::path& folder,
                   const SimulateOptions& options,
                   const std::string& laser_name,
                   const RigidTransform& world_from_scan,
                   double line_sigma) {
  AtomicFile file(folder / "capture.toml");
  std::ostream& out = file.stream();
  out.imbue(std::locale::classic());
  out.precision(17);
  const Eigen::Vector3d t = world_from_scan.translation * 1000;
  const Eigen::Quaterniond& q = world_from_scan.rotation;
  out << "rig = \"rig.toml\"\nlaser = " << std::quoted(laser_name)
      << "\n\n[frames]\non = \"frames/*.png\"\n";
  if (options.background_frames) out << "off = \"background/*.png\"\n";
  out << "\n[positions]\ncsv = \"positions.csv\"\n"
      << "\n[stripe]\nchannel = \"grey\"\nsigma_px = " << std::round(line_sigma * 100) / 100
      << "\n\n[pose]  # world_from_scan\n"
      << "translation_mm = [" << t.x() << ", " << t.y() << ", " << t.z() << "]\n"
      << "quaternion_xyzw = [" << q.x() << ", " << q.y() << ", " << q.z() << ", " << q.w() << "]\n";
  file.commit();
}

// One frame after the other goes to the disk: memory does not grow with their number.
void write_frames(const std::filesystem::path& folder,
                  const FrameRenderer& renderer,
                  const std::vector<RigidTransform>& world_from_camera,
                  const SimulateOptions& options) {
  const std::size_t count = world_from_camera.size();
  std::mutex counting;
  std::size_t done = 0;
  const auto render = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::string name = frame_name(i, count);
      write_image(folder / "frames" / name, renderer.render(world_from_camera[i], true, i).view());
      if (options.background_frames) {
        write_image(folder / "background" / name,
                    renderer.render(world_from_camera[i], false, i).view());
      }
      const std::lock_guard lock(counting);
      ++done;
      if (options.progress) options.progress(done, count);
    }
  };
  parallel_for(count, render, {.num_threads = options.num_threads, .chunk = 1});
}

}  // namespace

void simulate_capture(const std::filesystem::path& folder,
                      const Scene& scene,
                      const Rig& rig,
                      const SimulatedRun& run,
                      const SimulateOptions& options) {
  require(!run.positions.empty(), "a simulated run needs at least one axis position, but has none");
  const FrameRenderer renderer(scene, rig, options);
  prepare_folder(folder / "frames");
  if (options.background_frames) prepare_folder(folder / "background");
  const std::vector<double> positions = travelled(run.positions, options);
  std::vector<RigidTransform> world_from_camera;
  world_from_camera.reserve(positions.size());
  for (const double position : positions) {
    world_from_camera.push_back(run.world_from_scan * rig.axis.scan_from_camera_at(position));
    const double distance = world_from_camera.back().translation.norm();
    require(distance < kFarthest,
            "expected the camera within ",
            kFarthest,
            " m of the scene's origin, got ",
            distance,
            " m; check the position of the head, the rig's axis and its programme");
  }
  write_frames(folder, renderer, world_from_camera, options);
  const PolarScan truth = true_scan(scene, rig, run.world_from_scan, positions, options);
  write_scan(folder / "truth.pcd", truth);
  write_rig(folder / "rig.toml", rig);
  write_axis_positions(folder / "positions.csv", run.positions, rig.axis.kind);
  const double line_sigma = expected_line_sigma(truth, rig, laser_fan(rig, options));
  write_capture(folder, options, rig.lasers[options.laser].name, run.world_from_scan, line_sigma);
}

}  // namespace facula
