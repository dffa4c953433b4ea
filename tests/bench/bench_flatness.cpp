// SPDX-License-Identifier: GPL-3.0-or-later
// Flatness of a plate, from points to all figures, beside CGAL's exact width; and the two compared
// on 1000 clouds of all kinds.
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/flatness.hpp>
#include <facula/tests/bench/bench_scene.hpp>
#include <facula/tests/bench/flatness_judge_cgal.hpp>
#include <facula/tests/reconstruct/width_comparison.hpp>

#include <cmath>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

const double kUnit = std::ldexp(1.0, -30);  // floats between 1/64 and 1 are multiples of it

/// A plate of 1 m by 0.7 m with 0.1 mm of noise.
PointCloud plate(std::size_t count) {
  Random random(7);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d p(random.uniform(), 0.7 * random.uniform(), 1e-4 * random.normal());
    for (double& x : p) x = std::round(x / kUnit) * kUnit;
    cloud.points.emplace_back(p.cast<float>());
  }
  return cloud;
}

std::size_t points_of(const benchmark::State& state) {
  return small_run() ? 2000 : static_cast<std::size_t>(state.range(0));
}

/// Least squares (FLTt, FLTp, FLTv, FLTq) and minimum zone.
void flatness_own(benchmark::State& state) {
  const PointCloud cloud = plate(points_of(state));
  Flatness flatness;
  for (auto _ : state) flatness = measure_flatness(cloud);
  state.counters["least_squares_um"] = 1e6 * flatness.total;
  state.counters["minimum_zone_um"] = 1e6 * flatness.minimum_zone->total;
}

/// The minimum zone alone, by CGAL.
void minimum_zone_cgal(benchmark::State& state) {
  const PointCloud cloud = plate(points_of(state));
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : cloud.points) points.emplace_back(p.cast<double>());
  double width = 0;
  // A float below 1/64 has digits finer than kUnit, so the judge counts finer.
  for (auto _ : state) width = cgal_hull_and_width(points, std::ldexp(1.0, -60));
  state.counters["minimum_zone_um"] = 1e6 * width;
}

/// Largest relative difference from CGAL's Width_3; fails above 1e-9.
void thousand_clouds(benchmark::State& state) {
  const unsigned count = small_run() ? 50 : 1000;
  WidthComparison found;
  for (auto _ : state) found = compare_widths(count);
  const double worst = found.flat_is_zero ? found.worst : 1;
  state.counters["clouds"] = count;
  state.counters["worst_relative"] = worst;
  if (!(worst <= 1e-9)) state.SkipWithError("a width differs from CGAL's by more than 1e-9");
}

BENCHMARK(flatness_own)->Arg(10000)->Arg(200000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(minimum_zone_cgal)->Arg(10000)->Arg(200000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(thousand_clouds)->Iterations(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace facula
