// SPDX-License-Identifier: GPL-3.0-or-later
// Filters over 500 000 points beside PCL's, in one program: a room scan with its 2 mm noise.
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/grid_normals.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/filter/smoothing.hpp>
#include <facula/tests/bench/bench_scene.hpp>
#include <facula/tests/bench/filter_peers_pcl.hpp>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

constexpr int kThreads = 2;
constexpr int kNeighbours = 20;

/// The room's points without origins, as PCL takes them.
const PointCloud& bare_room() {
  static const PointCloud cloud = [] {
    PointCloud room = cloud_from_scan(room_scan(0));
    room.sensor_origin.clear();
    room.sigma.clear();
    room.intensity.clear();
    return room;
  }();
  return cloud;
}

void report(benchmark::State& state, std::size_t result) {
  if (result == 0) state.SkipWithError("nothing was left: the figure would mean nothing");
  state.counters["points"] = static_cast<double>(bare_room().size());
  state.counters["result"] = static_cast<double>(result);
}

void statistical_facula(benchmark::State& state) {
  std::size_t kept = 0;
  for (auto _ : state) {
    kept = statistical_inliers(bare_room(),
                               {.neighbours = kNeighbours, .max_ratio = 2, .num_threads = kThreads})
               .size();
  }
  report(state, kept);
}

void statistical_pcl(benchmark::State& state) {
  const PclCloud cloud(bare_room());
  std::size_t kept = 0;
  for (auto _ : state) kept = cloud.statistical_inliers(kNeighbours, 2);
  report(state, kept);
}

/// PCL's filter has one thread; this is the same work over its tree, shared by two.
void statistical_pcl_two_threads(benchmark::State& state) {
  const PclCloud cloud(bare_room());
  std::size_t kept = 0;
  for (auto _ : state) kept = cloud.statistical_inliers_threads(kNeighbours, 2, kThreads);
  report(state, kept);
}

void normals_facula(benchmark::State& state) {
  PointCloud cloud = bare_room();
  for (auto _ : state) {
    estimate_normals(cloud, {.neighbours = kNeighbours, .num_threads = kThreads});
  }
  report(state, cloud.normals.size());
}

void normals_pcl_omp(benchmark::State& state) {
  const PclCloud cloud(bare_room());
  std::size_t count = 0;
  for (auto _ : state) count = cloud.normals(kNeighbours, kThreads);
  report(state, count);
}

void normals_facula_grid(benchmark::State& state) {
  const PolarScan scan = room_scan(0);
  const PointCloud cloud = cloud_from_scan(scan);
  const ScanGrid grid = grid_from_scan(scan);
  GridNormalOptions options;
  options.num_threads = kThreads;
  std::size_t count = 0;
  for (auto _ : state) count = grid_normals(cloud, grid, options).size();
  report(state, count);
}

void thinning_facula(benchmark::State& state) {
  std::size_t count = 0;
  for (auto _ : state) count = thin_by_voxel(bare_room(), 0.03).size();
  report(state, count);
}

void thinning_pcl(benchmark::State& state) {
  const PclCloud cloud(bare_room());
  std::size_t count = 0;
  for (auto _ : state) count = cloud.thinned(0.03F);
  report(state, count);
}

void smoothing_facula(benchmark::State& state) {
  const SmoothingOptions options{
      .radius = small_run() ? 0.1 : 0.01, .default_sigma = 0.002, .num_threads = kThreads};
  std::size_t count = 0;
  for (auto _ : state) count = smooth(bare_room(), options).moved;
  report(state, count);
}

BENCHMARK(statistical_facula)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(statistical_pcl)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(statistical_pcl_two_threads)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(normals_facula)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(normals_pcl_omp)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(normals_facula_grid)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(thinning_facula)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(thinning_pcl)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(smoothing_facula)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace facula
