// SPDX-License-Identifier: GPL-3.0-or-later
// Registration without a guess over all pairs of a scan project whose poses are known:
//   global_pairs bun.conf [seeds]
// prints a line for every pair and seed, then how many were accepted and how far off they are. Each
// scan is turned at random first, so that no start is near the truth.
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/register/global_registration.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <vector>

namespace facula {
namespace {

constexpr double kDegree = M_PI / 180;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

RigidTransform random_pose(Random& random, double shift) {
  RigidTransform pose;
  pose.rotation =
      Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
          .normalized();
  for (int i = 0; i < 3; ++i) pose.translation[i] = shift * (2 * random.uniform() - 1);
  return pose;
}

/// The scans in frames of their own choice.
ScanProject scattered(const ScanProject& project, std::uint64_t seed) {
  Random random(seed, 77);
  ScanProject result = project;
  for (PosedCloud& scan : result.scans) {
    const RigidTransform moved = random_pose(random, 0.2);
    scan.cloud = transformed(scan.cloud, moved);
    scan.world_from_scan = scan.world_from_scan * moved.inverse();
  }
  return result;
}

struct Totals {
  int accepted = 0;
  int wrong = 0;  // accepted, but farther than 1 degree or 2 mm from the published pose
  double degrees = 0;
  double millimetres = 0;
};

void run_pair(const PosedCloud& s,
              const PosedCloud& t,
              const GlobalFeatures& source,
              const GlobalFeatures& target,
              Totals& totals) {
  const RigidTransform truth = t.world_from_scan.inverse() * s.world_from_scan;
  const double start = seconds();
  const GlobalResult result = register_without_guess(source, target);
  const double took = seconds() - start;
  // The difference at the middle of the scan: at the frame's origin a turn would count as a shift.
  const Eigen::Vector3d middle = middle_of(source.cloud);
  const RigidTransform& found = result.pair.target_from_source;
  const double degrees = found.rotation.angularDistance(truth.rotation) / kDegree;
  const double millimetres = 1000 * (found * middle - truth * middle).norm();
  const double possible =
      score_pose({*source.scan, source.view}, {*target.scan, target.view}, truth).overlap;
  std::printf("%-9s %-9s %5.1f %% at the published pose: %-9s %7.2f deg %7.2f mm %6.3f s  %s\n",
              s.name.c_str(),
              t.name.c_str(),
              100 * possible,
              to_string(result.verdict),
              degrees,
              millimetres,
              took,
              result.reason.c_str());
  if (result.verdict != Verdict::kAccepted) return;
  ++totals.accepted;
  if (degrees > 1 || millimetres > 2) ++totals.wrong;
  totals.degrees = std::max(totals.degrees, degrees);
  totals.millimetres = std::max(totals.millimetres, millimetres);
}

void run(const ScanProject& original, std::uint64_t seed) {
  const ScanProject project = scattered(original, seed);
  const double start = seconds();
  std::vector<ScanPyramid> pyramids;
  std::vector<const ScanPyramid*> all;
  pyramids.reserve(project.scans.size());
  for (const PosedCloud& scan : project.scans) {
    pyramids.push_back(build_pyramid(scan));
    all.push_back(&pyramids.back());
  }
  const double built = seconds();
  const double voxel = feature_voxel(all);
  std::vector<GlobalFeatures> features;
  for (const ScanPyramid* scan : all) {
    features.push_back(find_global_features(*scan, {.voxel = voxel}));
  }
  const double found = seconds();
  Totals totals;
  for (std::size_t i = 0; i < features.size(); ++i) {
    for (std::size_t j = i + 1; j < features.size(); ++j) {
      run_pair(project.scans[j], project.scans[i], features[j], features[i], totals);
    }
  }
  const double end = seconds();
  std::printf(
      "seed %d: accepted %d, wrong %d, worst %.2f deg %.2f mm; pyramids %.2f s, features "
      "%.2f s, pairs %.2f s\n",
      static_cast<int>(seed),
      totals.accepted,
      totals.wrong,
      totals.degrees,
      totals.millimetres,
      built - start,
      found - built,
      end - found);
  std::fflush(stdout);
}

}  // namespace
}  // namespace facula

int main(int count, char** arguments) {
  if (count < 2) {
    std::cerr << "usage: global_pairs SCANS [SEEDS]\n";
    return 2;
  }
  try {
    const auto project = facula::read_scan_project(arguments[1]);
    const int seeds = count > 2 ? std::atoi(arguments[2]) : 1;
    for (int seed = 1; seed <= seeds; ++seed) facula::run(project, std::uint64_t(seed));
  } catch (const facula::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
