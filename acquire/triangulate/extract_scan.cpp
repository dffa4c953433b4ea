// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/acquire/triangulate/logging_capture.hpp>
#include <facula/acquire/triangulate/scan_builder.hpp>
#include <facula/acquire/triangulate/sheet_gate.hpp>

#include <memory>
#include <mutex>

namespace facula {
namespace {

void check_capture(const Capture& capture, std::size_t frames) {
  require(frames == capture.positions.size() && frames > 0,
          "expected one axis position per frame, got ",
          capture.positions.size(),
          " positions for ",
          frames,
          " frames");
  require(capture.laser < capture.rig.light_count(),
          "expected a lit laser below ",
          capture.rig.light_count(),
          ", the number in the rig, got ",
          capture.laser);
  require(!capture.zero_line || capture.zero_line->frames.size() == frames,
          "expected one zero_line frame per frame, got ",
          capture.zero_line ? capture.zero_line->frames.size() : 0,
          " for ",
          frames);
}

}  // namespace

ExtractResult extract_scan(const Capture& capture, const ExtractOptions& options) {
  const CaptureFrames frames(capture);
  check_capture(capture, frames.size());
  const ColumnGate gate = sheet_gate(capture);
  std::unique_ptr<LoggingCapture> log;
  if (!options.log.empty()) log = std::make_unique<LoggingCapture>(capture, frames, gate, options);
  ScanBuilder builder(log ? log->settings() : capture, frames.size(), options.num_threads);

  std::mutex progress_mutex;
  std::size_t done = 0;
  const auto extract_frame = [&](std::size_t i, std::size_t) {
    builder.place(log ? log->measure(i) : measure_frame(capture, frames, gate, i));
    const std::lock_guard lock(progress_mutex);
    if (options.progress) options.progress(++done, frames.size());
  };
  parallel_for(frames.size(), extract_frame, {.num_threads = options.num_threads, .chunk = 1});
  ExtractResult result = builder.finish();
  if (log) result.log = log->figures();
  return result;
}

}  // namespace facula
