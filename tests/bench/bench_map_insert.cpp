// SPDX-License-Identifier: GPL-3.0-or-later
// Insertion of scans beside liboctomap's insertPointCloud, which must make the same tree.
#include <facula/acquire/rig/rig_file.hpp>
#include <facula/acquire/simulate/simulate.hpp>
#include <facula/map/octomap_bridge.hpp>
#include <facula/map/octomap_judge.hpp>
#include <facula/tests/bench/bench_scene.hpp>
#include <facula/tests/support/real_data.hpp>

#include <map>
#include <numbers>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

using Scans = std::vector<PointCloud>;

/// Three scans of the room with so many thousand rays each, from a single origin each.
const Scans& room_scans(int thousand_rays) {
  static std::map<int, Scans> made;
  Scans& scans = made[thousand_rays];
  const RoomGrid grid{.rows = thousand_rays, .cols = 1000};
  for (int stand = static_cast<int>(scans.size()); stand < 3; ++stand) {
    scans.push_back(room_cloud(stand, grid));
  }
  return scans;
}

/// The three stations of the demo in the furnished room, by their true ranges, every 1.2 degrees;
/// each column with an origin of its own.
const Scans& demo_scans() {
  static const Scans made = [] {
    const Scene scene = read_scene(shipped_data("scenes/furnished_room.toml"));
    const Rig rig = read_rig(shipped_data("rigs/head_fs1500.toml"));
    const double places[3][3] = {{-1.5, -0.3, 0}, {0.2, 0.8, 120}, {1.7, -0.3, -75}};
    Scans scans;
    for (const auto& [x, y, yaw] : places) {
      const double turn = yaw * std::numbers::pi / 180;
      const RigidTransform pose = {
          Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())), {x, y, 1.1}};
      std::vector<double> positions(small_run() ? 12 : 300);
      for (std::size_t i = 0; i < positions.size(); ++i) {
        positions[i] =
            2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(positions.size());
      }
      const PolarScan scan = true_scan(scene, rig, pose, positions, options_for(rig));
      scans.push_back(transformed(cloud_from_scan(scan), pose));
    }
    return scans;
  }();
  return made;
}

OccupancyOptions cells(double millimetres, int num_threads) {
  return {.resolution = millimetres / 1000, .num_threads = num_threads};
}

void count(benchmark::State& state, std::size_t rays, std::size_t memory) {
  state.counters["rays/s"] =
      benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["memory_MB"] = static_cast<double>(memory) / 1e6;
}

std::size_t rays_of(const Scans& scans) {
  std::size_t rays = 0;
  for (const PointCloud& scan : scans) rays += scan.size();
  return rays;
}

OccupancyMap map_of(const Scans& scans, const OccupancyOptions& options) {
  OccupancyMap map(options);
  for (const PointCloud& scan : scans) map.insert(scan);
  return map;
}

void insert_ours(benchmark::State& state, const Scans& scans, const OccupancyOptions& options) {
  std::size_t memory = 0;
  for (auto _ : state) memory = map_of(scans, options).bricks().memory_usage();
  count(state, rays_of(scans), memory);
}

void insert_theirs(benchmark::State& state, const Scans& scans, const OccupancyOptions& options) {
  const auto judge_of = [&] {
    OctomapJudge judge(options);
    for (const PointCloud& scan : scans) judge.insert(scan);
    return judge;
  };
  for (auto _ : state) benchmark::DoNotOptimize(judge_of());
  // A comparison of times is one only where the results are the same. Repetitions are not compared.
  static std::map<std::pair<const Scans*, double>, OctomapVerdict> verdicts;
  const auto key = std::pair(&scans, options.resolution);
  if (!verdicts.contains(key)) verdicts[key] = judge_of().verdict(map_of(scans, options));
  const OctomapVerdict& verdict = verdicts.at(key);
  if (!verdict.same_ot || !verdict.same_bt) state.SkipWithError("the two maps differ");
  count(state, rays_of(scans), verdict.memory);
}

void resolution_facula(benchmark::State& state) {
  insert_ours(state, room_scans(500), cells(static_cast<double>(state.range(0)), 0));
}
void resolution_facula_one_thread(benchmark::State& state) {
  insert_ours(state, room_scans(500), cells(static_cast<double>(state.range(0)), 1));
}
void resolution_octomap(benchmark::State& state) {
  insert_theirs(state, room_scans(500), cells(static_cast<double>(state.range(0)), 0));
}
void rays_facula(benchmark::State& state) {
  insert_ours(state, room_scans(static_cast<int>(state.range(0))), cells(50, 0));
}
void rays_octomap(benchmark::State& state) {
  insert_theirs(state, room_scans(static_cast<int>(state.range(0))), cells(50, 0));
}
void demo_facula(benchmark::State& state) {
  insert_ours(state, demo_scans(), cells(static_cast<double>(state.range(0)), 0));
}
void demo_octomap(benchmark::State& state) {
  insert_theirs(state, demo_scans(), cells(static_cast<double>(state.range(0)), 0));
}

/// So many scans of 125 000 rays one after the other: the time per scan must not grow.
void scans_facula(benchmark::State& state) {
  const Scans& three = room_scans(125);
  const auto number = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    OccupancyMap map(cells(50, 0));
    for (std::size_t i = 0; i < number; ++i) map.insert(three[i % 3]);
    benchmark::DoNotOptimize(map.bricks().entries().size());
  }
  state.counters["seconds_per_scan"] = benchmark::Counter(
      static_cast<double>(number),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void settings(benchmark::internal::Benchmark* bench) {
  bench->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}
void resolutions(benchmark::internal::Benchmark* bench) {
  bench->ArgName("mm")->Arg(100)->Arg(50)->Arg(20)->Apply(settings);
}
void rays(benchmark::internal::Benchmark* bench) {
  bench->ArgName("thousand_rays")->Arg(125)->Arg(500)->Arg(2000)->Apply(settings);
}

BENCHMARK(resolution_facula)->Apply(resolutions);
BENCHMARK(resolution_facula_one_thread)->Apply(resolutions);
BENCHMARK(resolution_octomap)->Apply(resolutions);
BENCHMARK(rays_facula)->Apply(rays);
BENCHMARK(rays_octomap)->Apply(rays);
BENCHMARK(demo_facula)->ArgName("mm")->Arg(50)->Apply(settings);
BENCHMARK(demo_octomap)->ArgName("mm")->Arg(50)->Apply(settings);
BENCHMARK(scans_facula)->ArgName("scans")->Arg(1)->Arg(10)->Arg(200)->Apply(settings);

}  // namespace
}  // namespace facula
