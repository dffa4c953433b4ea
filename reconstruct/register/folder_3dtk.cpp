// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/reconstruct/register/compressed_file.hpp>
#include <facula/reconstruct/register/scan_project_formats.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace facula {
namespace {

namespace fs = std::filesystem;

/// Ranges that are measurements [cm]. 3DTK writes `max` where nothing came back.
struct RangeLimits {
  double min = 0;
  double max = std::numeric_limits<double>::infinity();
};

/// 3DTK's frame is left-handed: x right, y up, z ahead, in cm. Ours: x ahead, y left, z up, in m.
Eigen::Matrix3d axes_from_3dtk() {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, 1, 0;
  return axes;
}

RangeLimits read_limits(const fs::path& config) {
  RangeLimits limits;
  if (!fs::exists(config)) return limits;
  const std::string bytes = read_whole_file(config);
  std::string_view text = bytes;
  while (!text.empty()) {
    std::string_view line = take_line(text);
    line = line.substr(0, line.find('#'));
    const std::string_view key = take_word(line, " \t=");
    const std::string_view value = take_word(line, " \t=");
    if (key != "min" && key != "max") continue;
    const auto number = parse_number<double>(value);
    require(number.has_value() && *number >= 0,
            "'",
            config.string(),
            "': ",
            key,
            " is '",
            value,
            "' where a range in cm was expected");
    (key == "min" ? limits.min : limits.max) = *number;
  }
  return limits;
}

std::vector<double> read_numbers(const fs::path& path) {
  const std::string bytes = read_whole_file(path);
  std::string_view text = bytes;
  std::vector<double> numbers;
  for (int line_number = 1; !text.empty(); ++line_number) {
    std::string_view line = take_line(text);
    for (auto word = take_word(line); !word.empty(); word = take_word(line)) {
      const auto number = parse_number<double>(word);
      require(number.has_value(),
              "'",
              path.string(),
              "', line ",
              line_number,
              ": '",
              word,
              "' is not a number");
      numbers.push_back(*number);
    }
  }
  return numbers;
}

/// Position, then Euler angles in degrees with R = Rx Ry Rz, all in 3DTK's frame.
RigidTransform read_pose(const fs::path& path) {
  const std::vector<double> n = read_numbers(path);
  require(n.size() == 6,
          "'",
          path.string(),
          "' holds ",
          n.size(),
          " numbers where a position and three angles (6) were expected");
  const auto turn = [&n](std::size_t i, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(n[i] * std::numbers::pi / 180, axis).toRotationMatrix();
  };
  const Eigen::Matrix3d rotation = turn(3, Eigen::Vector3d::UnitX()) *
                                   turn(4, Eigen::Vector3d::UnitY()) *
                                   turn(5, Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3d axes = axes_from_3dtk();
  RigidTransform pose = RigidTransform::from_rotation(axes * rotation * axes.transpose());
  pose.translation = axes * Eigen::Vector3d(n[0], n[1], n[2]) / 100;
  return pose;
}

/// Every line is x y z [cm].
PointCloud read_points(const fs::path& path, const RangeLimits& limits) {
  const std::vector<double> n = read_numbers(path);
  require(n.size() % 3 == 0,
          "'",
          path.string(),
          "' holds ",
          n.size(),
          " numbers, which is not three for every point");
  const double farthest = limits.max * (1 - 1e-5);  // written with six digits
  PointCloud cloud;
  for (std::size_t i = 0; i < n.size(); i += 3) {
    const Eigen::Vector3d p(n[i], n[i + 1], n[i + 2]);
    const double range = p.norm();
    if (!(range > 0 && range >= limits.min && range < farthest)) continue;
    cloud.points.emplace_back((axes_from_3dtk() * p / 100).cast<float>());
  }
  cloud.sensor_origin.assign(cloud.size(), Eigen::Vector3f::Zero());
  require(!cloud.empty(), "'", path.string(), "' has no point within the ranges of config.ini");
  return cloud;
}

/// The scan files of the folder by name ("scan000"), in order.
std::set<fs::path> scan_files(const fs::path& folder) {
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const fs::path plain = without_packing(entry.path());
    if (plain.extension() == ".3d" && plain.filename().string().starts_with("scan")) {
      files.insert(entry.path());
    }
  }
  require(!files.empty(),
          "the folder '",
          folder.string(),
          "' holds neither poses.toml nor scanNNN.3d files of 3DTK");
  return files;
}

/// A scan file and the .pose beside it.
PosedCloud read_scan(const fs::path& file, const RangeLimits& limits) {
  const UnpackedFile unpacked(file);
  PosedCloud scan;
  scan.name = without_packing(file).stem().string();
  scan.file = file;
  scan.cloud = read_points(unpacked.path(), limits);
  scan.world_from_scan = read_pose(file.parent_path() / (scan.name + ".pose"));
  return scan;
}

ListedScan listed(const fs::path& file, const RangeLimits& limits) {
  return {.name = without_packing(file).stem().string(), .file = file, .read = [file, limits] {
            return read_scan(file, limits);
          }};
}

}  // namespace

std::vector<ListedScan> list_3dtk_folder(const fs::path& folder) {
  const RangeLimits limits = read_limits(folder / "config.ini");
  std::vector<ListedScan> scans;
  for (const fs::path& file : scan_files(folder)) scans.push_back(listed(file, limits));
  return scans;
}

ListedScan list_3dtk_scan(const fs::path& file) {
  return listed(file, read_limits(file.parent_path() / "config.ini"));
}

}  // namespace facula
