// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/log/stripe_log_reader.hpp>
#include <facula/acquire/log/stripe_log_writer.hpp>
#include <facula/acquire/triangulate/extract_scan.hpp>
#include <facula/acquire/triangulate/measured_frame.hpp>

#include <atomic>
#include <cstddef>
#include <optional>
#include <vector>

namespace facula {

/// Measures the frames of a capture by way of a stripe log: a frame is first written there, then
/// measured from the bytes written, so that the log gives the same scan by construction.
class LoggingCapture {
 public:
  /// Begins options.log or, with options.resume and a log of that name, continues it. Throws Error
  /// where that log is of another recording. All but `options` must outlive it.
  LoggingCapture(const Capture& capture,
                 const CaptureFrames& frames,
                 const ColumnGate& gate,
                 const ExtractOptions& options);

  /// The capture as the log tells it.
  const Capture& settings() const { return settings_; }

  /// Frame i: from the log where it is there and sound, else from its images. Calls may run from
  /// several threads.
  MeasuredFrame measure(std::size_t i);

  LogFigures figures() const;

 private:
  std::optional<LoggedFrame> recorded(std::size_t i) const;
  LoggedFrame reread(const Bytes& record) const;

  const Capture& capture_;
  const CaptureFrames& frames_;
  const ColumnGate& gate_;
  StripeLogHeader header_;
  Image8 dark_;  ///< common background, rows as in the log
  Capture settings_;
  std::optional<StripeLogReader> before_;       ///< the log as it was found
  std::vector<std::optional<std::size_t>> at_;  ///< record of every frame there
  std::optional<StripeLogWriter> writer_;
  std::atomic<std::size_t> appended_{0};
  std::atomic<std::size_t> dropped_{0};
};

}  // namespace facula
