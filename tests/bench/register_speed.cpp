// SPDX-License-Identifier: GPL-3.0-or-later
// register_speed write CONF FOLDER: writes pairs of scans, starts and published poses for peers.
// register_speed time CONF ROUNDS: times register_pair() on those pairs from the loaded points. Per
// pair, way and round a line: who, pair, total [ms], loop [ms], off the published pose [deg], [mm].
#include <facula/acquire/core/cloud_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/register/pair_registration.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

namespace facula {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Pair {
  std::string name;
  PosedCloud source;
  PosedCloud target;
  RigidTransform published;
  RigidTransform start;  ///< 5 degrees about and 5 mm along every axis off
};

const PosedCloud& scan_named(const ScanProject& project, const std::string& name) {
  for (const PosedCloud& scan : project.scans) {
    if (scan.name == name) return scan;
  }
  fail("the project has no scan '", name, "'; give the bunny's bun.conf");
}

std::vector<Pair> read_pairs(const std::filesystem::path& conf) {
  const char* const names[][2] = {{"bun045", "bun000"},
                                  {"bun315", "bun000"},
                                  {"bun090", "bun045"},
                                  {"bun315", "bun270"},
                                  {"bun315", "bun045"}};
  const ScanProject project = read_scan_project(conf);
  Eigen::Matrix<double, 6, 1> off;
  off << Eigen::Vector3d::Constant(0.005), Eigen::Vector3d::Constant(5 * kDegree);
  std::vector<Pair> pairs;
  for (const auto& [source, target] : names) {
    Pair pair{std::string(source) + "_" + target,
              scan_named(project, source),
              scan_named(project, target),
              {},
              {}};
    pair.published = pair.target.world_from_scan.inverse() * pair.source.world_from_scan;
    pair.start = exp_se3(off) * pair.published;
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

void write_matrix(const std::filesystem::path& path, const RigidTransform& pose) {
  std::ofstream(path) << pose.matrix().format(Eigen::IOFormat(Eigen::FullPrecision)) << '\n';
}

void write_points(const std::filesystem::path& path, const PointCloud& cloud) {
  PointCloud bare;
  bare.points = cloud.points;
  write_cloud(path, bare);
}

void write_pairs(const std::vector<Pair>& pairs, const std::filesystem::path& folder) {
  for (const Pair& pair : pairs) {
    std::filesystem::create_directories(folder / pair.name);
    write_points(folder / pair.name / "source.ply", pair.source.cloud);
    write_points(folder / pair.name / "target.ply", pair.target.cloud);
    write_matrix(folder / pair.name / "start.txt", pair.start);
    write_matrix(folder / pair.name / "published.txt", pair.published);
  }
}

/// The reader computes normals from the scan's grid; the time for them belongs to registration.
Pair without_normals(Pair pair, bool keep_grid) {
  for (PosedCloud* scan : {&pair.source, &pair.target}) {
    scan->cloud.normals.clear();
    if (!keep_grid) scan->grid = {};
  }
  return pair;
}

void time_pair(const char* who, const Pair& pair, PairMethod method) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const ScanPyramid source = build_pyramid(pair.source);
  const ScanPyramid target = build_pyramid(pair.target);
  const auto ready = Clock::now();
  const PairResult result = register_pair(source, target, pair.start, {.method = method});
  const auto end = Clock::now();
  const auto ms = [](auto d) { return std::chrono::duration<double, std::milli>(d).count(); };
  std::printf("%s %s %.2f %.2f %.4f %.4f\n",
              who,
              pair.name.c_str(),
              ms(end - begin),
              ms(end - ready),
              rotation_angle(pair.published.inverse() * result.target_from_source) / kDegree,
              1000 * (result.target_from_source.translation - pair.published.translation).norm());
}

void time_all(const std::vector<Pair>& pairs, int rounds) {
  for (const Pair& pair : pairs) {
    const Pair with_grid = without_normals(pair, true);
    const Pair bare = without_normals(pair, false);
    for (int round = 0; round < rounds; ++round) {
      time_pair("facula_gicp", bare, PairMethod::kGeneralized);
      time_pair("facula_gicp_grid", with_grid, PairMethod::kGeneralized);
      time_pair("facula_point_to_plane", bare, PairMethod::kPointToPlane);
    }
  }
}

int run(const std::vector<std::string>& words) {
  require(words.size() == 3 && (words[0] == "write" || words[0] == "time"),
          "expected `write CONF FOLDER` or `time CONF ROUNDS`");
  const std::vector<Pair> pairs = read_pairs(words[1]);
  if (words[0] == "write") {
    write_pairs(pairs, words[2]);
  } else {
    time_all(pairs, std::atoi(words[2].c_str()));
  }
  return 0;
}

}  // namespace
}  // namespace facula

int main(int argc, char** argv) {
  try {
    return facula::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "register_speed: %s\n", error.what());
    return 1;
  }
}
