// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/arguments.hpp>
#include <facula/apps/commands/log_figures.hpp>

#include <string>

namespace facula {
namespace {

double share_percent(const LogFigures& log) {
  return log.raw_bytes == 0
             ? 0
             : 100 * static_cast<double>(log.bytes) / static_cast<double>(log.raw_bytes);
}

/// Axis positions of the first and the last sound record.
struct Travel {
  double first = 0;
  double last = 0;
};

Travel read_all(const StripeLogReader& log, LogFigures& found) {
  Travel travel;
  for (std::size_t i = 0; i < log.size(); ++i) {
    const auto frame = log.read(i);
    if (!frame) {
      ++found.dropped_records;
      continue;
    }
    if (found.frames == 0) travel.first = frame->position;
    travel.last = frame->position;
    ++found.frames;
  }
  return travel;
}

}  // namespace

void report_log(const LogFigures& log, Figures& figures) {
  figures.number("log_mb", "stripe log", 1e-6 * static_cast<double>(log.bytes), 2);
  figures.number("log_share_percent", "of the raw frames", share_percent(log), 2);
  figures.count("log_frames", "frames in the log", log.frames);
  figures.count("log_appended", "of them added now", log.appended);
  figures.count("log_dropped_records", "damaged records", log.dropped_records);
  figures.count("log_torn_bytes", "torn bytes at its end", log.torn_bytes);
}

void describe(const StripeLogReader& log, Figures& figures) {
  const StripeLogHeader& header = log.header();
  const Capture& capture = log.settings();
  figures.text("rig", "rig", capture.rig.name);
  figures.text("axis", "axis", to_string(capture.rig.axis.kind));
  figures.text("detector", "detector", to_string(capture.stripe.detector));
  figures.text("channel", "channel", to_string(capture.stripe.channel));
  figures.count("rows", "rows", static_cast<std::size_t>(header.rows));
  figures.count("row_px", "pixels in a row", static_cast<std::size_t>(header.cols));
  figures.count("window_px", "of them kept", static_cast<std::size_t>(header.width));
  figures.count("channels", "channels", static_cast<std::size_t>(header.channels));
  figures.count("recording_frames", "frames of the recording", header.frames);
  LogFigures found;
  found.bytes = log.bytes();
  found.dropped_records = log.damage().dropped_records;
  found.torn_bytes = log.damage().torn_bytes;
  const Travel travel = read_all(log, found);
  found.raw_bytes = header.raw_bytes(found.frames);
  const bool turns = capture.rig.axis.is_revolute();
  const double per_unit = turns ? 1 / kDegrees.factor : 1000;
  const std::string unit = turns ? "_deg" : "_mm";
  figures.number("first" + unit, "first position", travel.first * per_unit, 3);
  figures.number("last" + unit, "last position", travel.last * per_unit, 3);
  report_log(found, figures);
}

}  // namespace facula
