// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture_file.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/tests/bench/bench_scene.hpp>
#include <facula/tests/support/real_data.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>
#include <string>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

void extract(benchmark::State& state, const Capture& capture) {
  std::size_t frames = 0;
  std::size_t stripes = 0;
  for (auto _ : state) {
    const ExtractResult result = extract_scan(capture);
    frames = result.frames;
    stripes = result.stripes_seen;
  }
  if (stripes == 0) state.SkipWithError("no stripe was found: the figure would mean nothing");
  state.counters["frames"] = static_cast<double>(frames);
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(frames),
                                                  benchmark::Counter::kIsIterationInvariantRate);
  state.counters["stripes"] = static_cast<double>(stripes);
}

/// The clay pot, 72 colour frames of 1600 x 1200, read from their files each time.
void extract_pot(benchmark::State& state) {
  const auto frames = real_data("laser/caltag_turntable_pot");
  if (!frames) {
    state.SkipWithError("real data set 'laser/caltag_turntable_pot' is absent");
    return;
  }
  extract(state, read_capture(shipped_data("captures/caltag_turntable_pot"), frames));
}

/// A pan head of 640 x 480 whose frames are made here, read from their files each time.
void extract_made(benchmark::State& state) {
  const TemporaryFolder folder;
  Capture capture;
  capture.rig.camera = {
      .width = 640, .height = 480, .fx = 800, .fy = 800, .cx = 319.5, .cy = 239.5};
  const double tilt = 0.35;  // of the sheet, 0.25 m beside the camera [rad]
  LaserPlane sheet;
  sheet.normal = Eigen::Vector3d(std::cos(tilt), 0, std::sin(tilt));
  sheet.distance = 0.25 * std::cos(tilt);
  capture.rig.lasers = {sheet};
  capture.rig.axis.kind = AxisKind::kPan;
  const auto frames = stripe_frames(480, 640, small_run() ? 2 : 8);
  const int count = small_run() ? 4 : 64;
  for (int i = 0; i < count; ++i) {
    capture.frames.push_back(folder / ("frame" + std::to_string(i) + ".png"));
    write_image(capture.frames.back(), frames[static_cast<std::size_t>(i) % frames.size()].view());
    capture.positions.push_back(0.01 * i);
  }
  extract(state, capture);
}

BENCHMARK(extract_pot)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK(extract_made)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace facula
