// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/reconstruct/register/compressed_file.hpp>
#include <facula/reconstruct/register/scan_project_formats.hpp>

#include <array>
#include <cmath>
#include <string>
#include <string_view>

namespace facula {
namespace {

/// Where a line stands, for complaints.
struct Place {
  const std::filesystem::path& file;
  int line;
};

/// The seven numbers of a `bmesh` line: tx ty tz qx qy qz qw. The file's quaternion turns the world
/// into the scan, so x_in_world = R(conj(q)) x_in_scan + t.
RigidTransform parse_pose(std::string_view rest, const Place& place) {
  std::array<double, 7> n{};
  for (double& value : n) {
    const std::string_view word = take_word(rest);
    const auto number = parse_number<double>(word);
    require(number && std::isfinite(*number),
            "'",
            place.file.string(),
            "', line ",
            place.line,
            ": expected 'bmesh FILE tx ty tz qx qy qz qw', found '",
            word,
            "' where a number should stand");
    value = *number;
  }
  const Eigen::Quaterniond scan_from_world(n[6], n[3], n[4], n[5]);
  require(std::abs(scan_from_world.norm() - 1) < 1e-2,
          "'",
          place.file.string(),
          "', line ",
          place.line,
          ": the quaternion has length ",
          scan_from_world.norm(),
          " where 1 was expected");
  return {scan_from_world.normalized().conjugate(), {n[0], n[1], n[2]}};
}

/// A scan without its range grid: the scanner looked along -z of every scan (its stripe moves along
/// x), from far away compared with the object, so an origin 1 m in front of the points gives every
/// point its free side.
void set_sensor_in_front(PointCloud& cloud) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : cloud.points) centroid += p.cast<double>();
  centroid /= static_cast<double>(cloud.size());
  const Eigen::Vector3d origin = centroid + Eigen::Vector3d::UnitZ();
  cloud.sensor_origin.assign(cloud.size(), origin.cast<float>());
}

PosedCloud read_mesh_line(const std::filesystem::path& file, const RigidTransform& pose) {
  PosedCloud scan = read_scan_file(packed_or_plain(file));
  if (scan.grid.empty()) set_sensor_in_front(scan.cloud);
  scan.world_from_scan = pose;
  return scan;
}

}  // namespace

std::vector<ListedScan> list_stanford_conf(const std::filesystem::path& path) {
  const std::string bytes = read_whole_file(path);
  std::string_view text = bytes;
  std::vector<ListedScan> scans;
  for (int line_number = 1; !text.empty(); ++line_number) {
    std::string_view line = take_line(text);
    if (take_word(line) != "bmesh") continue;  // `camera` and `mesh` lines concern the renderer
    const std::filesystem::path file = path.parent_path() / std::string(take_word(line));
    const RigidTransform pose = parse_pose(line, {path, line_number});
    scans.push_back({.name = without_packing(file).stem().string(),
                     .file = file,
                     .read = [file, pose] { return read_mesh_line(file, pose); }});
  }
  require(!scans.empty(), "'", path.string(), "' names no scan: it has no `bmesh` line");
  return scans;
}

}  // namespace facula
