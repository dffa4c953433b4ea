// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/map/map_query.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/tests/bench/bench_scene.hpp>
#include <facula/tests/support/real_data.hpp>

#include <memory>
#include <optional>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

/// A map, OctoMap's tree of it, and questions spread evenly over its known box and a little around.
struct Subject {
  OccupancyMap map;
  std::unique_ptr<octomap::OcTree> tree;
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3f> directions;
};

const std::optional<Subject>& subject() {
  static const std::optional<Subject> made = []() -> std::optional<Subject> {
    const auto path = real_data("range/octomap-maps/fr_079.bt");
    if (!path) return std::nullopt;
    Subject result{OccupancyMap::read(*path), nullptr, {}, {}};
    result.tree = to_octomap(result.map);
    const MapStatistics statistics = result.map.statistics();
    const Eigen::Vector3d size = statistics.max - statistics.min;
    Random random(1);
    const std::size_t count = small_run() ? 1000 : 1000000;
    for (std::size_t i = 0; i < count; ++i) {
      Eigen::Vector3d at;
      Eigen::Vector3f along;
      for (Eigen::Index k = 0; k < 3; ++k) {
        at[k] = statistics.min[k] + size[k] * (1.1 * random.uniform() - 0.05);
        along[k] = static_cast<float>(random.normal());
      }
      result.points.push_back(at);
      result.directions.push_back(along);
    }
    return result;
  }();
  return made;
}

bool ready(benchmark::State& state) {
  if (!subject()) state.SkipWithError("range/octomap-maps/fr_079.bt is absent");
  return subject().has_value();
}

void report_queries(benchmark::State& state, std::size_t count) {
  state.counters["queries/s"] =
      benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate);
}

CellState state_in_octomap(const octomap::OcTree& tree, const Eigen::Vector3d& x) {
  const octomap::OcTreeNode* node = tree.search(x.x(), x.y(), x.z());
  if (node == nullptr) return CellState::kUnknown;
  return tree.isNodeOccupied(node) ? CellState::kOccupied : CellState::kFree;
}

std::vector<CellState> states_in_octomap() {
  std::vector<CellState> states;
  states.reserve(subject()->points.size());
  for (const Eigen::Vector3d& x : subject()->points) {
    states.push_back(state_in_octomap(*subject()->tree, x));
  }
  return states;
}

void states_facula(benchmark::State& state, int num_threads) {
  if (!ready(state)) return;
  const MapQuery query(subject()->map);
  for (auto _ : state)
    benchmark::DoNotOptimize(query.states(subject()->points, num_threads).data());
  report_queries(state, subject()->points.size());
}

void search_facula(benchmark::State& state) {
  states_facula(state, 0);
}

void search_facula_one_thread(benchmark::State& state) {
  states_facula(state, 1);
}

/// What making the tables costs, which the others have behind them.
void prepare_facula(benchmark::State& state) {
  if (!ready(state)) return;
  for (auto _ : state) benchmark::DoNotOptimize(MapQuery(subject()->map).memory_usage());
  state.counters["bytes"] = static_cast<double>(MapQuery(subject()->map).memory_usage());
}

void search_octomap(benchmark::State& state) {
  if (!ready(state)) return;
  std::vector<CellState> states;
  for (auto _ : state) {
    states = states_in_octomap();
    benchmark::DoNotOptimize(states.data());
  }
  // A comparison of times is one only where the answers are the same.
  if (states != MapQuery(subject()->map).states(subject()->points)) {
    state.SkipWithError("the answers differ");
  }
  report_queries(state, states.size());
}

std::size_t ray_count() {
  return subject()->points.size() / 20;
}

/// Keys of the occupied cells that rays end in, none where they end elsewhere. Rays pass unknown
/// cells.
using RayEnds = std::vector<std::optional<CellKey>>;

RayEnds rays_with_facula(const MapQuery& query) {
  RayEnds ends(ray_count());
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const RayHit hit = query.cast_ray(subject()->points[i].cast<float>(),
                                      subject()->directions[i],
                                      {.max_range = 10, .unknown = UnknownCells::kFree});
    if (hit.end == RayHit::End::kOccupied) ends[i] = hit.cell;
  }
  return ends;
}

RayEnds rays_with_octomap() {
  RayEnds ends(ray_count());
  const octomap::OcTree& tree = *subject()->tree;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    octomap::point3d end;
    const octomap::point3d origin = to_octomap(Eigen::Vector3f(subject()->points[i].cast<float>()));
    if (!tree.castRay(origin, to_octomap(subject()->directions[i]), end, true, 10)) continue;
    const octomap::OcTreeKey key = tree.coordToKey(end);
    ends[i] = CellKey{key[0], key[1], key[2]};
  }
  return ends;
}

void cast_facula(benchmark::State& state) {
  if (!ready(state)) return;
  const MapQuery query(subject()->map);
  for (auto _ : state) benchmark::DoNotOptimize(rays_with_facula(query).data());
  report_queries(state, ray_count());
}

void cast_octomap(benchmark::State& state) {
  if (!ready(state)) return;
  RayEnds ends;
  for (auto _ : state) {
    ends = rays_with_octomap();
    benchmark::DoNotOptimize(ends.data());
  }
  if (ends != rays_with_facula(MapQuery(subject()->map))) {
    state.SkipWithError("the answers differ");
  }
  report_queries(state, ray_count());
}

void in_milliseconds(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}

BENCHMARK(search_facula)->Apply(in_milliseconds);
BENCHMARK(search_facula_one_thread)->Apply(in_milliseconds);
BENCHMARK(search_octomap)->Apply(in_milliseconds);
BENCHMARK(prepare_facula)->Apply(in_milliseconds);
BENCHMARK(cast_facula)->Apply(in_milliseconds);
BENCHMARK(cast_octomap)->Apply(in_milliseconds);

}  // namespace
}  // namespace facula
