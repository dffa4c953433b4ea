// SPDX-License-Identifier: GPL-3.0-or-later
// covariance_study [PAIRS [FIRST_SEED]]: registers simulated pairs of scans and says how often the
// true pose lies within the 95 % bounds of the covariance that register_pair() states, in Markdown.
#include <facula/reconstruct/register/pair_registration.hpp>
#include <facula/tests/reconstruct/simulated_pair.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>

namespace facula {
namespace {

// 2.5 % and 97.5 % quantiles of chi squared with 6 degrees of freedom.
constexpr double kLow = 1.237;
constexpr double kHigh = 14.449;

struct Study {
  const char* name;
  PairMethod method;
  bool with_sigma;
  int pairs = 0;
  int low = 0;
  int high = 0;
  double sum = 0;
  double found_mm = 0;  ///< squared, of the translation
  double stated_mm = 0;
  double found_deg = 0;
  double stated_deg = 0;

  void add(const Eigen::Matrix<double, 6, 1>& error, const PairResult& result) {
    const double nees = error.dot(result.covariance.ldlt().solve(error));
    ++pairs;
    sum += nees;
    if (nees < kLow) ++low;
    if (nees > kHigh) ++high;
    found_mm += 1e6 * error.head<3>().squaredNorm();
    stated_mm += 1e6 * result.covariance.topLeftCorner<3, 3>().trace();
    const double degrees = 180 / std::numbers::pi;
    found_deg += degrees * degrees * error.tail<3>().squaredNorm();
    stated_deg += degrees * degrees * result.covariance.bottomRightCorner<3, 3>().trace();
  }

  void print() const {
    const double n = pairs;
    std::printf(
        "| %s | %d | %.1f %% | %.1f %% | %.1f %% | %.2f | %.3f mm, %.5f° | %.3f mm, %.5f° |\n",
        name,
        pairs,
        100 * (n - low - high) / n,
        100 * low / n,
        100 * high / n,
        sum / n,
        std::sqrt(found_mm / n),
        std::sqrt(found_deg / n),
        std::sqrt(stated_mm / n),
        std::sqrt(stated_deg / n));
  }
};

RigidTransform rough(const RigidTransform& truth) {
  Eigen::Matrix<double, 6, 1> off;
  off << 0.05, -0.04, 0.03, 0.02, -0.02, 0.03;
  return exp_se3(off) * truth;
}

void run(Study& study, SimulatedPair pair) {
  if (!study.with_sigma) {
    pair.source.cloud.sigma.clear();
    pair.target.cloud.sigma.clear();
  }
  const ScanPyramid source = build_pyramid(pair.source);
  const ScanPyramid target = build_pyramid(pair.target);
  const PairResult result =
      register_pair(source, target, rough(pair.target_from_source), {.method = study.method});
  study.add(log_se3(pair.target_from_source * result.target_from_source.inverse()), result);
}

void study_all(int pairs, std::uint64_t first) {
  std::vector<Study> studies = {{"generalised", PairMethod::kGeneralized, true},
                                {"point to plane", PairMethod::kPointToPlane, true},
                                {"generalised, no sigma", PairMethod::kGeneralized, false},
                                {"point to plane, no sigma", PairMethod::kPointToPlane, false}};
  for (int i = 0; i < pairs; ++i) {
    const SimulatedPair pair = simulate_pair({.seed = first + static_cast<std::uint64_t>(i)});
    for (Study& study : studies) run(study, pair);
  }
  std::puts("| method | pairs | inside | below | above | mean | rms error | stated |");
  std::puts("|---|---|---|---|---|---|---|---|");
  for (const Study& study : studies) study.print();
}

}  // namespace
}  // namespace facula

int main(int argc, char** argv) {
  const int pairs = argc > 1 ? std::atoi(argv[1]) : 200;
  const int first = argc > 2 ? std::atoi(argv[2]) : 1;
  facula::study_all(pairs, static_cast<std::uint64_t>(first));
  return 0;
}
