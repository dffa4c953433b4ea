// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/triangulate/extract_log.hpp>
#include <facula/acquire/triangulate/measured_frame.hpp>
#include <facula/acquire/triangulate/scan_builder.hpp>

#include <mutex>

namespace facula {
namespace {

void check_fit(const StripeLogReader& log, const Rig& rig) {
  const Rig& logged = log.settings().rig;
  require(rig.camera.width == logged.camera.width && rig.camera.height == logged.camera.height,
          "the stripe log '",
          log.name(),
          "' holds frames of ",
          logged.camera.width,
          " x ",
          logged.camera.height,
          " px, and the rig's camera has ",
          rig.camera.width,
          " x ",
          rig.camera.height,
          "; name the rig that recorded it");
  require(rig.stripe_direction == logged.stripe_direction,
          "the stripe log '",
          log.name(),
          "' holds a stripe that runs the other way than the rig says; name the rig that recorded "
          "it");
}

/// Guards against a log whose frame numbers are absurd: a column needs memory.
void check_columns(const StripeLogReader& log) {
  require(log.size() > 0,
          "the stripe log '",
          log.name(),
          "' holds no whole frame yet; continue it with --resume");
  constexpr std::size_t kLargestGap = 100;
  require(log.columns() <= kLargestGap * (log.size() + 100),
          "the stripe log '",
          log.name(),
          "' says that its last frame is number ",
          log.columns() - 1,
          ", and holds ",
          log.size(),
          " frames; restore the file from a copy");
}

}  // namespace

ExtractResult extract_scan(const StripeLogReader& log,
                           const Capture& capture,
                           const ExtractOptions& options) {
  check_fit(log, capture.rig);
  check_columns(log);
  capture.stripe.check();
  ScanBuilder builder(capture, log.columns(), options.num_threads);

  std::mutex mutex;
  std::size_t done = 0;
  LogFigures figures;
  figures.bytes = log.bytes();
  figures.dropped_records = log.damage().dropped_records;
  figures.torn_bytes = log.damage().torn_bytes;
  const auto extract_record = [&](std::size_t i, std::size_t) {
    const auto frame = log.read(i);
    if (frame) builder.place(measure_logged(*frame, log.settings().stripe, capture));
    const std::lock_guard lock(mutex);
    ++(frame ? figures.frames : figures.dropped_records);
    if (options.progress) options.progress(++done, log.size());
  };
  parallel_for(log.size(), extract_record, {.num_threads = options.num_threads, .chunk = 1});
  require(figures.frames > 0,
          "none of the ",
          log.size(),
          " records of the stripe log '",
          log.name(),
          "' is whole; restore the file from a copy");
  ExtractResult result = builder.finish();
  figures.raw_bytes = log.header().raw_bytes(figures.frames);
  result.log = figures;
  return result;
}

}  // namespace facula
