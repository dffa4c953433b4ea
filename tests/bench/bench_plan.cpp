// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/path_plan.hpp>
#include <facula/tests/bench/bench_scene.hpp>
#include <facula/tests/support/real_data.hpp>

#include <string>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

struct Way {
  const char* map;
  Eigen::Vector3d from;  ///< [m]
  Eigen::Vector3d to;    ///< [m]
  PathPlanOptions options;
};

/// A plan with everything it needs but the reading of the map: field, search, check. The argument
/// is the seed.
void plan(benchmark::State& state, Way way) {
  const auto path = real_data(std::string("range/octomap-maps/") + way.map);
  if (!path) {
    state.SkipWithError("range/octomap-maps is absent");
    return;
  }
  const OccupancyMap map = OccupancyMap::read(*path);
  way.options.seed = static_cast<std::uint32_t>(state.range(0));
  PathPlan found;
  for (auto _ : state) found = plan_path(map, way.from, way.to, way.options);
  state.counters["length_m"] = found.length;
  state.counters["least_clearance_m"] = found.least_clearance;
  state.counters["samples"] = static_cast<double>(found.samples.size());
  state.counters["tries"] = static_cast<double>(found.tries);
}

const Eigen::Vector3d kWestEnd(-5, -0.24, 0.6);

void fr_079_corridor(benchmark::State& state) {
  plan(state, {"fr_079.bt", kWestEnd, {24, 0.4, 0.6}, {.radius = 0.25}});
}

void fr_079_room(benchmark::State& state) {
  const PathPlanOptions options{.radius = 0.25, .unknown = UnknownCells::kFree};
  plan(state, {"fr_079.bt", kWestEnd, {26.4, 3.4, 0.6}, options});
}

void geb079_corridor(benchmark::State& state) {
  plan(state, {"geb079.bt", kWestEnd, {23, -0.9, 0.6}, {.radius = 0.25}});
}

void geb079_room(benchmark::State& state) {
  const PathPlanOptions options{.radius = 0.25, .unknown = UnknownCells::kFree};
  plan(state, {"geb079.bt", kWestEnd, {25.9, 4.2, 0.6}, options});
}

void seeds(benchmark::internal::Benchmark* bench) {
  bench->DenseRange(1, small_run() ? 1 : 5)
      ->ArgName("seed")
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

BENCHMARK(fr_079_corridor)->Apply(seeds);
BENCHMARK(fr_079_room)->Apply(seeds);
BENCHMARK(geb079_corridor)->Apply(seeds);
BENCHMARK(geb079_room)->Apply(seeds);

}  // namespace
}  // namespace facula
