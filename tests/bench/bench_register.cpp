// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/pair_registration.hpp>
#include <facula/tests/bench/bench_scene.hpp>

#include <numbers>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

PosedCloud room(int stand) {
  PosedCloud scan;
  scan.name = "room";
  scan.cloud = room_cloud(stand);
  return scan;
}

void pyramid_of_room(benchmark::State& state) {
  const PosedCloud scan = room(0);
  std::size_t points = 0;
  for (auto _ : state) points = build_pyramid(scan).levels[0].cloud.size();
  state.counters["points"] = static_cast<double>(points);
}

/// The second stand onto the first, from a start 3 degrees and 10 cm off.
void register_room(benchmark::State& state) {
  const ScanPyramid target = build_pyramid(room(0));
  const ScanPyramid source = build_pyramid(room(1));
  Eigen::Matrix<double, 6, 1> offset;
  offset << 0.08, -0.05, 0.03, 0.02, -0.02, 0.04;
  PairOptions options;
  options.method = state.range(0) == 0 ? PairMethod::kPointToPlane : PairMethod::kGeneralized;
  PairResult result;
  for (auto _ : state) result = register_pair(source, target, exp_se3(offset), options);
  const double degrees = rotation_angle(result.target_from_source) * 180 / std::numbers::pi;
  const double millimetres = 1000 * result.target_from_source.translation.norm();
  if (degrees > 1 || millimetres > 20) state.SkipWithError("the scans were not registered");
  state.counters["points"] = static_cast<double>(source.levels[0].cloud.size());
  state.counters["iterations"] = result.iterations;
  state.counters["error_deg"] = degrees;
  state.counters["error_mm"] = millimetres;
}

BENCHMARK(pyramid_of_room)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(register_room)
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace facula
