// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/nearest_name.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/toml_text.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/reconstruct/register/compressed_file.hpp>
#include <facula/reconstruct/register/scan_project_formats.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <toml++/toml.h>

namespace facula {
namespace {

namespace fs = std::filesystem;

using Covariance = Eigen::Matrix<double, 6, 6>;

constexpr const char* kCovariance = "covariance_m_rad";

void require_known_keys(const toml::table& table,
                        const std::vector<std::string>& known,
                        const std::string& where) {
  for (const auto& [key, value] : table) {
    const std::string name(key.str());
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = nearest_name(name, known);
    fail(where,
         ": unknown key '",
         name,
         "'",
         near.empty() ? std::string() : "; did you mean '" + near + "'?");
  }
}

std::string name_of(const fs::path& path) {
  return std::string("'").append(path.string()).append("'");
}

toml::table parse(const fs::path& path) {
  const std::string text = read_whole_file(path);
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& problem) {
    fail("'",
         path.string(),
         "', line ",
         problem.source().begin.line,
         ", column ",
         problem.source().begin.column,
         ": ",
         problem.description());
  }
}

/// The numbers of an array; nothing when the key is absent.
template <std::size_t N>
std::optional<std::array<double, N>> numbers_if(const toml::table& table,
                                                const char* key,
                                                const std::string& where) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return {};
  const toml::array* list = node->as_array();
  require(list != nullptr && list->size() == N,
          where,
          ": ",
          key,
          " should be a list of ",
          N,
          " numbers");
  std::array<double, N> numbers{};
  for (std::size_t i = 0; i < N; ++i) {
    const auto number = (*list)[i].template value<double>();
    require(number && std::isfinite(*number), where, ": ", key, " holds a value that is no number");
    numbers[i] = *number;
  }
  return numbers;
}

RigidTransform pose_of_scan(const toml::table& table, const std::string& where) {
  RigidTransform pose;
  if (const auto t = numbers_if<3>(table, "translation_mm", where)) {
    pose.translation = Eigen::Vector3d((*t)[0], (*t)[1], (*t)[2]) / 1000;
  }
  if (const auto q = numbers_if<4>(table, "quaternion_xyzw", where)) {
    pose.rotation = Eigen::Quaterniond((*q)[3], (*q)[0], (*q)[1], (*q)[2]);
    require(std::abs(pose.rotation.norm() - 1) < 1e-2,
            where,
            ": quaternion_xyzw has length ",
            pose.rotation.norm(),
            " where 1 was expected");
    pose.rotation.normalize();
  }
  return pose;
}

/// From the 21 numbers of its upper triangle, row by row; zero where there are none.
Covariance covariance_of_scan(const toml::table& table, const std::string& where) {
  Covariance covariance = Covariance::Zero();
  const auto numbers = numbers_if<21>(table, kCovariance, where);
  if (!numbers) return covariance;
  auto next = numbers->begin();
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index col = row; col < 6; ++col) {
      covariance(row, col) = covariance(col, row) = *next++;
    }
  }
  // Metres and radians compare once each has a variance of 1.
  const Eigen::VectorXd scale =
      covariance.diagonal().unaryExpr([](double x) { return x > 0 ? 1 / std::sqrt(x) : 1.0; });
  const Covariance scaled = scale.asDiagonal() * covariance * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Covariance> solver(scaled, Eigen::EigenvaluesOnly);
  require(solver.eigenvalues()(0) > -1e-9,
          where,
          ": ",
          kCovariance,
          " is the covariance of nothing, for some combination of its parts has a negative "
          "variance; leave it out or register the scans again");
  return covariance;
}

std::vector<double> upper_triangle(const Covariance& covariance) {
  std::vector<double> numbers;
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index col = row; col < 6; ++col) numbers.push_back(covariance(row, col));
  }
  return numbers;
}

/// What poses.toml says of a scan.
struct ScanEntry {
  fs::path file;
  std::string name = {};
  /// Wins over the VIEWPOINT of the scan's own file.
  std::optional<RigidTransform> world_from_scan = {};
  Covariance covariance = Covariance::Zero();
};

PosedCloud read_entry(const ScanEntry& entry) {
  PosedCloud scan = read_scan_file(packed_or_plain(entry.file));
  scan.name = entry.name;
  scan.world_from_scan = entry.world_from_scan.value_or(scan.world_from_scan);
  scan.pose_covariance = entry.covariance;
  return scan;
}

ListedScan list_entry(const toml::table& table, const fs::path& path, std::size_t number) {
  const std::string where = name_of(path) + ", scan " + std::to_string(number);
  require_known_keys(
      table, {"name", "file", "translation_mm", "quaternion_xyzw", kCovariance}, where);
  const auto file = table["file"].value<std::string>();
  require(file && !file->empty(), where, ": missing the key file, the name of the scan's file");
  ScanEntry entry{.file = path.parent_path() / *file};
  entry.name = table["name"].value_or(without_packing(entry.file).stem().string());
  if (table.contains("translation_mm") || table.contains("quaternion_xyzw")) {
    entry.world_from_scan = pose_of_scan(table, where);
  }
  entry.covariance = covariance_of_scan(table, where);
  return {.name = entry.name, .file = entry.file, .read = [entry] { return read_entry(entry); }};
}

/// A TOML float needs a point or an exponent.
std::string toml_number(double value) {
  const std::string text = number_text(value);
  return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

template <typename Numbers>
std::string toml_list(const Numbers& values) {
  std::string list;
  for (const double value : values) list += (list.empty() ? "[" : ", ") + toml_number(value);
  return list + "]";
}

/// `file` as seen from `folder` where that is possible.
std::string relative_name(const fs::path& file, const fs::path& folder) {
  const fs::path base = folder.empty() ? fs::path(".") : folder;
  const fs::path relative = fs::absolute(file).lexically_normal().lexically_relative(
      fs::absolute(base).lexically_normal());
  return relative.empty() ? fs::absolute(file).generic_string() : relative.generic_string();
}

}  // namespace

std::vector<ListedScan> list_poses_file(const fs::path& path) {
  const toml::table file = parse(path);
  require_known_keys(file, {"scan"}, name_of(path));
  const toml::array* entries = file["scan"].as_array();
  require(entries != nullptr && !entries->empty() && entries->is_homogeneous<toml::table>(),
          "'",
          path.string(),
          "' names no scan: write a [[scan]] table with file, translation_mm, quaternion_xyzw for "
          "every scan");
  std::vector<ListedScan> scans;
  for (const toml::node& entry : *entries) {
    scans.push_back(list_entry(*entry.as_table(), path, scans.size() + 1));
  }
  return scans;
}

void write_poses(const fs::path& path, const ScanProject& project) {
  AtomicFile file(path);
  file.stream() << "# x_in_world = R(quaternion) x_in_scan + translation\n"
                   "# covariance_m_rad: of the twist (shift, turn) in true pose = exp(twist) pose, "
                   "upper triangle row by row\n";
  for (const PosedCloud& scan : project.scans) {
    const RigidTransform& pose = scan.world_from_scan;
    file.stream() << "\n[[scan]]\nname = " << toml_quoted(scan.name)
                  << "\nfile = " << toml_quoted(relative_name(scan.file, path.parent_path()))
                  << "\ntranslation_mm = " << toml_list(Eigen::Vector3d(pose.translation * 1000))
                  << "\nquaternion_xyzw = " << toml_list(pose.rotation.coeffs()) << '\n';
    const Covariance& covariance = scan.pose_covariance;
    if (covariance.isZero(0) || !covariance.allFinite()) continue;
    file.stream() << kCovariance << " = " << toml_list(upper_triangle(covariance)) << '\n';
  }
  file.commit();
}

}  // namespace facula
