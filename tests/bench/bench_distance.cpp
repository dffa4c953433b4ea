// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/distance_field.hpp>
#include <facula/tests/bench/bench_scene.hpp>
#include <facula/tests/bench/distance_rival_octomap.hpp>
#include <facula/tests/support/real_data.hpp>

#include <algorithm>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

// The argument is the distance [mm] at which both sides cut.

constexpr const char* kMap = "range/octomap-maps/fr_079.bt";

struct Subject {
  OccupancyMap map;
  CellBox box;
};

/// The corridor of Freiburg's building 079 at 5 cm, or a corner of it.
Subject subject_of(const std::filesystem::path& path) {
  Subject subject{OccupancyMap::read(path), {}};
  subject.box = known_box(subject.map).value();
  if (small_run()) {
    for (std::size_t i = 0; i < 3; ++i) {
      subject.box.high[i] = std::min(subject.box.high[i], subject.box.low[i] + 60);
    }
  }
  return subject;
}

DistanceField field_of(const Subject& subject, double max_distance, int num_threads) {
  return DistanceField(
      subject.map, {.box = subject.box, .max_distance = max_distance, .num_threads = num_threads});
}

double max_distance(const benchmark::State& state) {
  return 0.001 * static_cast<double>(state.range(0));
}

void report_cells(benchmark::State& state, const CellBox& box) {
  const auto cells = static_cast<double>(box.cells());
  state.counters["cells"] = cells;
  state.counters["cells/s"] =
      benchmark::Counter(cells, benchmark::Counter::kIsIterationInvariantRate);
}

void with_facula(benchmark::State& state, int num_threads) {
  const auto path = real_data(kMap);
  if (!path) {
    state.SkipWithError("range/octomap-maps/fr_079.bt is absent");
    return;
  }
  const Subject subject = subject_of(*path);
  for (auto _ : state) {
    benchmark::DoNotOptimize(field_of(subject, max_distance(state), num_threads).memory_usage());
  }
  report_cells(state, subject.box);
}

void field_facula(benchmark::State& state) {
  with_facula(state, 0);
}

void field_facula_one_thread(benchmark::State& state) {
  with_facula(state, 1);
}

struct Agreement {
  double nearer = 0;   ///< cells that the rival says are nearer to an obstacle than they are [1]
  double farther = 0;  ///< and farther [1]
};

/// Cells nearer than `max_distance` by the exact field. The rival's obstacles all have distance 0.
Agreement agreement(const DistanceRival& rival, const DistanceField& exact) {
  const CellBox& box = exact.box();
  Agreement result;
  CellKey cell{};
  for (cell[2] = box.low[2]; cell[2] <= box.high[2]; ++cell[2]) {
    for (cell[1] = box.low[1]; cell[1] <= box.high[1]; ++cell[1]) {
      for (cell[0] = box.low[0]; cell[0] <= box.high[0]; ++cell[0]) {
        const auto squared = exact.squared_cells(cell);
        if (!squared) continue;
        const std::int32_t theirs = rival.squared_cells(cell);
        result.nearer += theirs < std::max(*squared, 0) ? 1 : 0;
        result.farther += theirs > std::max(*squared, 0) ? 1 : 0;
      }
    }
  }
  return result;
}

void field_dynamic_edt(benchmark::State& state) {
  const auto path = real_data(kMap);
  if (!path) {
    state.SkipWithError("range/octomap-maps/fr_079.bt is absent");
    return;
  }
  const Subject subject = subject_of(*path);
  DistanceRival rival(*path);
  for (auto _ : state) rival.compute(subject.box, max_distance(state));
  report_cells(state, subject.box);
  // The rival hands obstacles on from neighbour to neighbour, which may miss the nearest one; it
  // never finds one that is not there.
  const Agreement found = agreement(rival, field_of(subject, max_distance(state), 0));
  state.counters["farther_than_exact"] = found.farther;
  if (found.nearer > 0 || found.farther > 1e-3 * static_cast<double>(subject.box.cells())) {
    state.SkipWithError("the two fields differ");
  }
}

void limits(benchmark::internal::Benchmark* bench) {
  bench->Arg(1000)
      ->Arg(100000)
      ->ArgName("mm")
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

BENCHMARK(field_facula)->Apply(limits);
BENCHMARK(field_facula_one_thread)->Apply(limits);
BENCHMARK(field_dynamic_edt)->Apply(limits);

}  // namespace
}  // namespace facula
