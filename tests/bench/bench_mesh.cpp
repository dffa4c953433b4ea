// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>
#include <facula/tests/bench/bench_scene.hpp>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

void report(benchmark::State& state, std::size_t points, std::size_t triangles) {
  if (triangles == 0) state.SkipWithError("no triangle was made: the figure would mean nothing");
  state.counters["points"] = static_cast<double>(points);
  state.counters["triangles"] = static_cast<double>(triangles);
}

/// One scan of the room, thinned to the voxel given [mm]. In the scan's own frame no wall lies on a
/// border between voxels, where noise would make every point two.
void mesh_front(benchmark::State& state) {
  const double voxel = 0.001 * static_cast<double>(state.range(0));
  const PointCloud cloud = thin_by_voxel(cloud_from_scan(room_scan(1)), voxel);
  const AdvancingFrontOptions options{.max_edge = 4 * voxel};
  std::size_t triangles = 0;
  for (auto _ : state) triangles = mesh_advancing_front(cloud, options).triangles.size();
  report(state, cloud.size(), triangles);
}

/// One scan of 500 x 1000 cells.
void mesh_cells(benchmark::State& state) {
  const PolarScan scan = room_scan(0);
  const GridMeshOptions options{.max_edge = small_run() ? 0.5 : 0.05};  // few cells, long edges
  std::size_t triangles = 0;
  for (auto _ : state) triangles = mesh_grid(scan, options).triangles.size();
  report(state, scan.valid_count(), triangles);
}

BENCHMARK(mesh_front)
    ->Arg(150)
    ->Arg(75)
    ->ArgName("mm")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(mesh_cells)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace facula
