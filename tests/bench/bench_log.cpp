// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/acquire/log/log_record.hpp>
#include <facula/acquire/log/log_settings.hpp>
#include <facula/acquire/log/stripe_log_writer.hpp>
#include <facula/acquire/triangulate/extract_log.hpp>
#include <facula/tests/bench/bench_scene.hpp>
#include <facula/tests/support/temporary_folder.hpp>

#include <cmath>

#include <benchmark/benchmark.h>
namespace facula {
namespace {

/// A pan head of 640 x 480, grey, lens and sheet as real ones bend them.
Capture pan_capture(int frames) {
  Capture capture;
  Rig& rig = capture.rig;
  rig.camera = {.width = 640,
                .height = 480,
                .fx = 800,
                .fy = 800,
                .cx = 319.5,
                .cy = 239.5,
                .k1 = -0.1,
                .k2 = 0.02,
                .p1 = 0.001};
  const double tilt = 0.35;  // of the sheet, 0.25 m beside the camera [rad]
  LaserPlane sheet;
  sheet.normal = Eigen::Vector3d(std::cos(tilt), 0, std::sin(tilt));
  sheet.distance = 0.25 * std::cos(tilt);
  sheet.bow = 0.005;
  rig.lasers = {sheet};
  rig.axis.kind = AxisKind::kPan;
  for (int i = 0; i < frames; ++i) capture.positions.push_back(0.001 * i);
  return capture;
}

std::filesystem::path write_log(const TemporaryFolder& folder, int frames) {
  const Capture capture = pan_capture(frames);
  const StripeLogHeader header = header_of(capture, 1);
  const auto path = folder / "scan.flog";
  auto writer = StripeLogWriter::create(path, header, {});
  const auto images = stripe_frames(480, 640, small_run() ? 2 : 8);
  std::vector<LoggedView> views;
  for (const Image8& image : images) {
    views.push_back(log_view({image.view(), {}}, capture.stripe, header.width));
  }
  for (std::size_t i = 0; i < capture.positions.size(); ++i) {
    LoggedFrame frame;
    frame.index = i;
    frame.position = capture.positions[i];
    frame.views = {views[i % views.size()]};
    writer.append(encode_frame(frame, header));
  }
  return path;
}

/// From the file to the scan: what a person waits for after a new calibration.
void log_to_scan(benchmark::State& state) {
  const TemporaryFolder folder;
  const int frames = small_run() ? 4 : static_cast<int>(state.range(0));
  const auto path = write_log(folder, frames);
  std::size_t points = 0;
  for (auto _ : state) {
    const StripeLogReader log(path);
    const ExtractResult result = extract_scan(log, log.settings());
    points = result.scan.valid_count();
    benchmark::DoNotOptimize(result.scan.point.data());
  }
  const double full = 0.9 * 480 * frames;
  if (static_cast<double>(points) < full) state.SkipWithError("the stripe was not found");
  const double raw = 640.0 * 480.0 * frames;
  state.counters["points"] = static_cast<double>(points);
  state.counters["rows/s"] =
      benchmark::Counter(480.0 * frames, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["log_percent"] = 100 * static_cast<double>(std::filesystem::file_size(path)) / raw;
}

/// The same file's bytes alone.
void read_log_bytes(benchmark::State& state) {
  const TemporaryFolder folder;
  const auto path = write_log(folder, small_run() ? 4 : static_cast<int>(state.range(0)));
  for (auto _ : state) {
    const std::string bytes = read_whole_file(path);
    benchmark::DoNotOptimize(bytes.data());
  }
}

void frame_counts(benchmark::internal::Benchmark* bench) {
  bench->Arg(100)->Arg(600)->Arg(1000)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
  bench->UseRealTime();
}

BENCHMARK(log_to_scan)->Apply(frame_counts);
BENCHMARK(read_log_bytes)->Apply(frame_counts);

}  // namespace
}  // namespace facula
