// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/tests/bench/bench_scene.hpp>

#include <cstring>

#include <benchmark/benchmark.h>

namespace facula {
namespace {

/// Eight frames in turn, so that a frame is not still in the nearest cache from the time before.
constexpr int kFrames = 8;

std::vector<Image8> frames_for(const benchmark::State& state) {
  return stripe_frames(static_cast<int>(state.range(1)), static_cast<int>(state.range(0)), kFrames);
}

void report_pixels(benchmark::State& state) {
  const auto pixels = static_cast<double>(state.range(0) * state.range(1));
  state.counters["Gpx/s"] =
      benchmark::Counter(1e-9 * pixels, benchmark::Counter::kIsIterationInvariantRate);
}

void detect(benchmark::State& state, DetectorKind detector) {
  const auto frames = frames_for(state);
  StripeOptions options;
  options.detector = detector;
  std::size_t i = 0;
  std::size_t seen = 0;
  for (auto _ : state) {
    const StripeProfile profile = detect_stripe(frames[i++ % kFrames].view(), {}, options);
    seen += profile.seen_count();
    benchmark::DoNotOptimize(profile.position.data());
  }
  if (seen == 0) state.SkipWithError("no stripe was found: the figure would mean nothing");
  report_pixels(state);
}

/// What the memory alone allows: every byte is read once, eight at a time.
void plain_read(benchmark::State& state) {
  const auto frames = frames_for(state);
  std::size_t i = 0;
  for (auto _ : state) {
    const Image8& frame = frames[i++ % kFrames];
    std::uint64_t sum = 0;
    for (std::size_t at = 0; at + 8 <= frame.pixels.size(); at += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, frame.pixels.data() + at, 8);
      sum += word;
    }
    benchmark::DoNotOptimize(sum);
  }
  report_pixels(state);
}

void detect_fir(benchmark::State& state) {
  detect(state, DetectorKind::kFirZeroCrossing);
}

void detect_centroid(benchmark::State& state) {
  detect(state, DetectorKind::kCentroid);
}

void frame_sizes(benchmark::internal::Benchmark* bench) {
  bench->Args({640, 480})->Args({1920, 1080})->Unit(benchmark::kMillisecond);
}

BENCHMARK(detect_fir)->Apply(frame_sizes);
BENCHMARK(detect_centroid)->Apply(frame_sizes);
BENCHMARK(plain_read)->Apply(frame_sizes);

}  // namespace
}  // namespace facula
