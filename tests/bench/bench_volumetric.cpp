// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/mesh_file.hpp>
#include <facula/reconstruct/filter/point_spacing.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>
#include <facula/reconstruct/mesh/volumetric_merge.hpp>
#include <facula/tests/bench/bench_scene.hpp>
#include <facula/tests/bench/hall.hpp>
#include <facula/tests/support/real_data.hpp>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

double millimetres(const std::vector<double>& distances, double share) {
  return 1e3 * quantile({distances.begin(), distances.end()}, share);
}

/// The ten bunny scans with their published poses, and how far the mesh and the zippered model lie
/// apart [mm]. The argument is the voxel [um], 0 = from the sampling.
void merge_bunny(benchmark::State& state) {
  const auto folder = real_data("range/stanford-bunny");
  if (!folder) {
    state.SkipWithError("range/stanford-bunny is absent");
    return;
  }
  const ScanProject scans = read_scan_project(*folder / "data/bun.conf");
  const TriangleMesh zipper = read_mesh(*folder / "reconstruction/bun_zipper.ply");
  const VolumetricOptions options{.voxel = 1e-6 * static_cast<double>(state.range(0))};
  VolumetricResult merged;
  for (auto _ : state) merged = merge_volumetric(scans, options);
  const std::vector<double> from_mesh = distances_to_mesh(merged.mesh.vertices, zipper);
  const std::vector<double> from_zipper = distances_to_mesh(zipper.vertices, merged.mesh);
  state.counters["triangles"] = static_cast<double>(merged.mesh.triangles.size());
  state.counters["mesh_to_zipper_median_mm"] = millimetres(from_mesh, 0.5);
  state.counters["mesh_to_zipper_p95_mm"] = millimetres(from_mesh, 0.95);
  state.counters["zipper_to_mesh_median_mm"] = millimetres(from_zipper, 0.5);
  state.counters["zipper_to_mesh_p95_mm"] = millimetres(from_zipper, 0.95);
}

/// Two stations of the hall at a voxel of 50 mm.
void merge_hall(benchmark::State& state) {
  HallOptions hall{.stations = 2, .rows = 400, .cols = 1000};
  if (small_run()) hall = {.stations = 2, .rows = 40, .cols = 100};
  ScanProject scans;
  for (std::size_t i = 0; i < 2; ++i) scans.scans.push_back(hall_scan(i, hall));
  const VolumetricOptions options{.voxel = small_run() ? 0.5 : 0.05};
  VolumetricResult merged;
  for (auto _ : state) merged = merge_volumetric(scans, options);
  state.counters["points"] = 2.0 * hall.rows * hall.cols;
  state.counters["triangles"] = static_cast<double>(merged.mesh.triangles.size());
}

BENCHMARK(merge_bunny)
    ->Arg(0)
    ->Arg(500)
    ->Arg(1000)
    ->ArgName("um")
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();
BENCHMARK(merge_hall)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace facula
