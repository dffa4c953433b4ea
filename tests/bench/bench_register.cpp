// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/register/icp.hpp>
#include <facula/tests/bench/bench_scene.hpp>

#include <numbers>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

PointCloud thinned_room(int stand) {
  PointCloud cloud = thin_by_voxel(room_cloud(stand), small_run() ? 0.1 : 0.03);
  estimate_normals(cloud);
  return cloud;
}

/// The second stand onto the first, from a start 3 degrees and 10 cm off.
void register_room(benchmark::State& state) {
  const PointCloud target = thinned_room(0);
  const PointCloud source = thinned_room(1);
  Eigen::Matrix<double, 6, 1> offset;
  offset << 0.08, -0.05, 0.03, 0.02, -0.02, 0.04;
  IcpResult result;
  for (auto _ : state) result = register_icp(source, target, exp_se3(offset));
  const double degrees = rotation_angle(result.target_from_source) * 180 / std::numbers::pi;
  const double millimetres = 1000 * result.target_from_source.translation.norm();
  if (degrees > 1 || millimetres > 20) state.SkipWithError("the scans were not registered");
  state.counters["points"] = static_cast<double>(source.size());
  state.counters["iterations"] = result.iterations;
  state.counters["error_deg"] = degrees;
  state.counters["error_mm"] = millimetres;
}

void normals_of_room(benchmark::State& state) {
  PointCloud cloud = thinned_room(0);
  for (auto _ : state) estimate_normals(cloud);
  state.counters["points"] = static_cast<double>(cloud.size());
}

BENCHMARK(register_room)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(normals_of_room)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace facula
