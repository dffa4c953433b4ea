// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/scan_header.hpp>
#include <facula/acquire/core/text_numbers.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr std::string_view kMark = "facula scan 1";
constexpr std::string_view kColumn = "facula column ";
constexpr std::string_view kStand = "facula stand ";

/// Reads one column's comment into the scan; false when it is torn.
bool read_column(std::string_view text, std::size_t expected, PolarScan& scan) {
  const auto number = parse_number<std::size_t>(take_word(text));
  if (number != expected || expected >= scan.axis_position.size()) return false;
  std::array<double, 5> values{};
  for (double& value : values) {
    const auto parsed = parse_number<double>(take_word(text));
    if (!parsed) return false;
    value = *parsed;
  }
  scan.axis_position[expected] = values[0];
  scan.time[expected] = values[1];
  scan.sensor_origin[expected] = {values[2], values[3], values[4]};
  return take_word(text).empty();
}

ScanStand read_stand(std::string_view name, const std::filesystem::path& path) {
  const auto stand = stand_from_name(name);
  require(stand.has_value(),
          "the header of '",
          path.string(),
          "' says that the scan stands '",
          name.substr(0, 40),
          "'; expected free, upright or table");
  return *stand;
}

}  // namespace

std::vector<std::string> scan_comments(const PolarScan& scan) {
  std::vector<std::string> comments{std::string(kMark)};
  if (scan.stand != ScanStand::kFree) {
    comments.push_back(std::string(kStand) + to_string(scan.stand));
  }
  for (std::size_t i = 0; i < scan.axis_position.size(); ++i) {
    const Eigen::Vector3d& origin = scan.sensor_origin[i];
    comments.push_back(std::string(kColumn) + number_text(i) + " " +
                       number_text(scan.axis_position[i]) + " " + number_text(scan.time[i]) + " " +
                       number_text(origin.x()) + " " + number_text(origin.y()) + " " +
                       number_text(origin.z()));
  }
  return comments;
}

bool has_scan_comments(const std::vector<std::string>& comments) {
  return std::find(comments.begin(), comments.end(), kMark) != comments.end();
}

void read_scan_comments(const std::vector<std::string>& comments,
                        PolarScan& scan,
                        const std::filesystem::path& path) {
  std::size_t columns = 0;
  for (const std::string& comment : comments) {
    if (comment.starts_with(kStand)) {
      scan.stand = read_stand(std::string_view(comment).substr(kStand.size()), path);
    }
    if (!comment.starts_with(kColumn)) continue;
    require(read_column(std::string_view(comment).substr(kColumn.size()), columns, scan),
            "the header of '",
            path.string(),
            "' has a torn comment for column ",
            columns,
            "; write the scan again");
    ++columns;
  }
  require(columns == scan.axis_position.size(),
          "the header of '",
          path.string(),
          "' describes ",
          columns,
          " columns where the scan has ",
          scan.axis_position.size(),
          "; write the scan again");
}

std::array<double, 7> viewpoint_of(const RigidTransform& world_from_scan) {
  const Eigen::Vector3d& t = world_from_scan.translation;
  const Eigen::Quaterniond& q = world_from_scan.rotation;
  return {t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z()};
}

RigidTransform pose_of(const std::array<double, 7>& viewpoint, const std::filesystem::path& path) {
  RigidTransform pose;
  pose.translation = {viewpoint[0], viewpoint[1], viewpoint[2]};
  pose.rotation = Eigen::Quaterniond(viewpoint[3], viewpoint[4], viewpoint[5], viewpoint[6]);
  const double length = pose.rotation.norm();
  require(pose.translation.allFinite() && std::isfinite(length) && length > 1e-6,
          "the VIEWPOINT of '",
          path.string(),
          "' is no pose; expected tx ty tz qw qx qy qz with a quaternion of length 1");
  // A unit quaternion stays as it is, so that a scan is read back bit for bit.
  if (std::abs(length - 1) > 1e-12) pose.rotation.normalize();
  return pose;
}

}  // namespace facula
