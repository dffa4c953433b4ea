// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/map/octomap_bridge.hpp>
#include <facula/tests/bench/bench_scene.hpp>

#include <array>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

constexpr int kStands = 3;

const std::array<PointCloud, kStands>& clouds() {
  static const std::array<PointCloud, kStands> made = {room_cloud(0), room_cloud(1), room_cloud(2)};
  return made;
}

double resolution(const benchmark::State& state) {
  return 0.001 * static_cast<double>(state.range(0));
}

void report_scans(benchmark::State& state) {
  const auto rays = static_cast<double>(kStands * clouds()[0].size());
  state.counters["rays/s"] =
      benchmark::Counter(rays, benchmark::Counter::kIsIterationInvariantRate);
}

OccupancyMap map_with_facula(double cell, int num_threads) {
  OccupancyMap map({.resolution = cell, .num_threads = num_threads});
  for (const PointCloud& cloud : clouds()) map.insert(cloud);
  return map;
}

octomap::OcTree map_with_octomap(double cell) {
  octomap::OcTree tree(cell);
  for (const PointCloud& cloud : clouds()) {
    tree.insertPointCloud(to_octomap(cloud), to_octomap(cloud.sensor_origin.front()));
  }
  return tree;
}

void insert(benchmark::State& state, int num_threads) {
  clouds();
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        map_with_facula(resolution(state), num_threads).bricks().entries().size());
  }
  report_scans(state);
}

void insert_facula(benchmark::State& state) {
  insert(state, 0);
}

void insert_facula_one_thread(benchmark::State& state) {
  insert(state, 1);
}

void insert_octomap(benchmark::State& state) {
  clouds();
  for (auto _ : state) {
    benchmark::DoNotOptimize(map_with_octomap(resolution(state)).size());
  }
  // A comparison of times is one only where the results are the same.
  if (!(*to_octomap(map_with_facula(resolution(state), 0)) ==
        map_with_octomap(resolution(state)))) {
    state.SkipWithError("the two maps differ");
  }
  report_scans(state);
}

void cells(benchmark::internal::Benchmark* bench) {
  bench->Arg(100)
      ->Arg(50)
      ->Arg(20)
      ->ArgName("mm")
      ->Unit(benchmark::kMillisecond)
      ->MeasureProcessCPUTime()
      ->UseRealTime();
}

BENCHMARK(insert_facula)->Apply(cells);
BENCHMARK(insert_facula_one_thread)->Apply(cells);
BENCHMARK(insert_octomap)->Apply(cells);

}  // namespace
}  // namespace facula
