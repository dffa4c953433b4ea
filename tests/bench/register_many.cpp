// SPDX-License-Identifier: GPL-3.0-or-later
// register_many bunny [SHUFFLES] | room [STEP_DEG] | foreign
//
// Registration of many scans from nothing, against known poses. bunny: the ten scans of the set
// range/stanford-bunny in shuffled orders, each order with 2 threads, the first also with 1.
// room: eight stations of the simulated head in data/scenes/furnished_room.toml, from frames.
// foreign: both sets, each with one scan of something else at a time, as a Markdown table.
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/tests/bench/foreign_scans.hpp>
#include <facula/tests/bench/room_stations.hpp>
#include <facula/tests/support/real_data.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace facula {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct Outcome {
  RegisterScansResult result;
  std::vector<RigidTransform> poses;
  double seconds = 0;
  double worst_angle = 0;     // of placed scans against the truth [rad]
  double worst_distance = 0;  // of their frames' origins [m]
};

Outcome registered(const KnownProject& known, int num_threads) {
  ScanProject project = known.project;
  RegisterScansOptions options;
  options.start = ScanStart::kNothing;
  options.num_threads = num_threads;
  const auto start = std::chrono::steady_clock::now();
  Outcome outcome;
  outcome.result = register_scans(project, options);
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  for (const PosedCloud& scan : project.scans) outcome.poses.push_back(scan.world_from_scan);
  return outcome;
}

/// Pose errors after the anchor was laid onto its true pose.
std::pair<double, double> error_of_scan(const KnownProject& known,
                                        const Outcome& outcome,
                                        std::size_t i) {
  const std::size_t a = outcome.result.anchor;
  const RigidTransform true_from_found = known.truth[a] * outcome.poses[a].inverse();
  const RigidTransform found = true_from_found * outcome.poses[i];
  return {rotation_angle(known.truth[i].inverse() * found),
          (known.truth[i].translation - found.translation).norm()};
}

void print_edges(const KnownProject& known, const Outcome& outcome) {
  for (const ScanEdge& edge : outcome.result.edges) {
    const auto& scans = known.project.scans;
    const RigidTransform truth = known.truth[edge.edge.to].inverse() * known.truth[edge.edge.from];
    const RigidTransform off = truth.inverse() * edge.edge.to_from_from;
    std::printf(
        "  %-9s %-9s %-8s overlap %4.1f %% rms %.3f mm chi2 %9.2f redundancy %.2f off %.3f deg "
        "%.3f mm  %s\n",
        scans[edge.edge.from].name.c_str(),
        scans[edge.edge.to].name.c_str(),
        to_string(edge.verdict),
        100 * edge.overlap,
        1000 * edge.inlier_rms,
        edge.residual.chi2,
        edge.residual.redundancy,
        rotation_angle(off) / kDegree,
        1000 * off.translation.norm(),
        edge.reason.c_str());
  }
}

void print_scans(const KnownProject& known, Outcome& outcome) {
  for (std::size_t i = 0; i < known.truth.size(); ++i) {
    const ScanPlacement& place = outcome.result.scans[i];
    const std::string& name = known.project.scans[i].name;
    if (!place.placed) {
      std::printf("  %-10s refused: %s\n", name.c_str(), place.reason.c_str());
      continue;
    }
    const auto [angle, distance] = error_of_scan(known, outcome, i);
    outcome.worst_angle = std::max(outcome.worst_angle, angle);
    outcome.worst_distance = std::max(outcome.worst_distance, distance);
    std::printf(
        "  %-10s off %.4f deg %.4f mm; sigma %.4f mm; %zu edges, checked %.2f, overlap %.0f %%\n",
        name.c_str(),
        angle / kDegree,
        1000 * distance,
        1000 * std::sqrt(std::max(0.0, place.covariance.diagonal().head<3>().maxCoeff())),
        place.edges,
        place.checked,
        100 * place.overlap);
  }
}

/// Worst errors when the placed scans, as one body, are laid onto the truth.
std::pair<double, double> errors_as_one_body(const KnownProject& known, const Outcome& outcome) {
  constexpr std::size_t kEvery = 100;
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;
  for (std::size_t i = 0; i < known.truth.size(); ++i) {
    const auto& points = known.project.scans[i].cloud.points;
    for (std::size_t p = 0; outcome.result.scans[i].placed && p < points.size(); p += kEvery) {
      from.push_back(outcome.poses[i] * points[p].cast<double>());
      to.push_back(known.truth[i] * points[p].cast<double>());
    }
  }
  const auto matrix = [](std::vector<Eigen::Vector3d>& v) {
    return Eigen::Map<Eigen::Matrix3Xd>(v.front().data(), 3, static_cast<Eigen::Index>(v.size()));
  };
  std::pair<double, double> worst{0, 0};
  if (from.empty()) return worst;
  const RigidTransform back =
      RigidTransform::from_matrix(Eigen::umeyama(matrix(from), matrix(to), false));
  for (std::size_t i = 0; i < known.truth.size(); ++i) {
    if (!outcome.result.scans[i].placed) continue;
    const RigidTransform found = back * outcome.poses[i];
    worst.first = std::max(worst.first, rotation_angle(known.truth[i].inverse() * found));
    worst.second = std::max(worst.second, (known.truth[i].translation - found.translation).norm());
  }
  return worst;
}

void report(const char* what, const KnownProject& known, Outcome& outcome) {
  std::printf("%s\n", what);
  print_edges(known, outcome);
  print_scans(known, outcome);
  std::printf("  placed %zu of %zu, worst %.4f deg %.4f mm, scan sigma %.4f mm, %.2f s\n",
              outcome.result.placed,
              known.truth.size(),
              outcome.worst_angle / kDegree,
              1000 * outcome.worst_distance,
              1000 * outcome.result.scan_sigma,
              outcome.seconds);
  const auto [angle, distance] = errors_as_one_body(known, outcome);
  std::printf("  all placed scans laid onto the truth as one body: worst %.4f deg %.4f mm\n",
              angle / kDegree,
              1000 * distance);
  std::fflush(stdout);
}

bool same_poses(const Outcome& a, const Outcome& b) {
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    if (a.poses[i].translation != b.poses[i].translation ||
        a.poses[i].rotation.coeffs() != b.poses[i].rotation.coeffs()) {
      return false;
    }
  }
  return true;
}

KnownProject shuffled(const ScanProject& published, std::uint64_t seed) {
  KnownProject known;
  std::vector<std::size_t> order;
  Random random(seed);
  for (std::size_t i = 0; i < published.scans.size(); ++i) {
    order.insert(order.begin() + static_cast<std::ptrdiff_t>(random.below(i + 1)), i);
  }
  for (const std::size_t i : order) {
    known.project.scans.push_back(published.scans[i]);
    known.truth.push_back(published.scans[i].world_from_scan);
    known.project.scans.back().world_from_scan = {};
  }
  return known;
}

int study_bunny(int shuffles) {
  const auto folder = real_data("range/stanford-bunny");
  if (!folder) {
    std::puts("the set range/stanford-bunny is absent");
    return 0;
  }
  const ScanProject published = read_scan_project(*folder / "data" / "bun.conf");
  for (int s = 0; s < shuffles; ++s) {
    const KnownProject known = shuffled(published, static_cast<std::uint64_t>(s));
    Outcome outcome = registered(known, 2);
    report(("bunny, order " + std::to_string(s)).c_str(), known, outcome);
    if (s > 0) continue;
    const Outcome alone = registered(known, 1);
    std::printf("  with 1 thread: %s, %.2f s\n",
                same_poses(outcome, alone) ? "the same bits" : "OTHER POSES",
                alone.seconds);
  }
  return 0;
}

int study_room(double step) {
  const KnownProject known = eight_stations(step);
  Outcome outcome = registered(known, 2);
  report("room of eight stations", known, outcome);
  const Outcome alone = registered(known, 1);
  std::printf("  with 1 thread: %s, %.2f s\n",
              same_poses(outcome, alone) ? "the same bits" : "OTHER POSES",
              alone.seconds);
  return 0;
}

/// One line per foreign scan, which is laid first into the set.
void add_foreign(const char* set, const KnownProject& known, std::vector<PosedCloud> foreign) {
  for (PosedCloud& scan : foreign) {
    KnownProject mixed = known;
    mixed.project.scans.insert(mixed.project.scans.begin(), scan);
    mixed.truth.insert(mixed.truth.begin(), RigidTransform{});
    Outcome outcome = registered(mixed, 0);
    for (std::size_t i = 1; i < mixed.truth.size(); ++i) {
      if (!outcome.result.scans[i].placed) continue;
      const auto [angle, distance] = error_of_scan(mixed, outcome, i);
      outcome.worst_angle = std::max(outcome.worst_angle, angle);
      outcome.worst_distance = std::max(outcome.worst_distance, distance);
    }
    const bool placed = outcome.result.scans[0].placed;
    std::printf("| %s | %s | %s | %zu of %zu | %.3f°, %.2f mm |\n",
                set,
                scan.name.c_str(),
                placed ? "PLACED" : "refused",
                outcome.result.placed - (placed ? 1 : 0),
                known.truth.size(),
                outcome.worst_angle / kDegree,
                1000 * outcome.worst_distance);
    std::fflush(stdout);
    std::fprintf(stderr,
                 "%s stays; %s\n",
                 mixed.project.scans[outcome.result.anchor].name.c_str(),
                 outcome.result.scans[0].reason.c_str());
  }
}

int study_foreign() {
  std::puts("| set | with a scan of | that scan | the set's own scans placed | worst of these |");
  std::puts("|---|---|---|---|---|");
  if (const auto folder = real_data("range/stanford-bunny")) {
    const ScanProject published = read_scan_project(*folder / "data" / "bun.conf");
    add_foreign("bunny", shuffled(published, 0), foreign_objects());
  }
  add_foreign("room", eight_stations(2.4 * kDegree), foreign_rooms());
  return 0;
}

int study(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "bunny") return study_bunny(argc > 2 ? std::atoi(argv[2]) : 5);
  if (what == "foreign") return study_foreign();
  if (what == "room") return study_room((argc > 2 ? std::atof(argv[2]) : 1.2) * kDegree);
  std::fprintf(stderr, "expected bunny, room or foreign, got '%s'\n", what.c_str());
  return 2;
}

}  // namespace
}  // namespace facula

int main(int argc, char** argv) {
  try {
    return facula::study(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
