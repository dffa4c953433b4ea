// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/log/log_record.hpp>
#include <facula/acquire/log/log_settings.hpp>
#include <facula/acquire/triangulate/logging_capture.hpp>

namespace facula {
namespace {

/// The common background with the rows of the log as its rows.
Image8 common_background(const Capture& capture,
                         const CaptureFrames& frames,
                         const StripeLogHeader& header) {
  if (header.background != LoggedBackground::kCommon) return {};
  const Image8 frame = frames.dark(0);
  const WindowPlaces whole{header.cols,
                           std::vector<std::int32_t>(static_cast<std::size_t>(header.rows), 0)};
  const bool transpose = capture.stripe.direction == StripeDirection::kPerColumn;
  return cut_windows(frame.view(), {}, whole, transpose).lit;
}

}  // namespace

LoggingCapture::LoggingCapture(const Capture& capture,
                               const CaptureFrames& frames,
                               const ColumnGate& gate,
                               const ExtractOptions& options)
    : capture_(capture), frames_(frames), gate_(gate), at_(capture.positions.size()) {
  const CapturedFrame first = read_images(capture, frames, 0).scene;
  require(first.dark.empty() ||
              (first.dark.rows == first.lit.rows && first.dark.cols == first.lit.cols &&
               first.dark.channels == first.lit.channels),
          "expected a background of the frames' size ",
          first.lit.cols,
          " x ",
          first.lit.rows,
          " and channels, got ",
          first.dark.cols,
          " x ",
          first.dark.rows,
          " px with ",
          first.dark.channels,
          " channels");
  header_ = header_of(capture, first.lit.channels);
  settings_ = capture_of(header_, options.log.string());
  settings_.positions = capture.positions;
  dark_ = common_background(capture, frames, header_);
  if (!options.resume || !std::filesystem::exists(options.log)) {
    writer_.emplace(StripeLogWriter::create(options.log, header_, dark_.view()));
    return;
  }
  before_.emplace(options.log);
  check_same_recording(before_->header(), header_, options.log.string());
  for (std::size_t r = 0; r < before_->size(); ++r) at_[before_->frame_index(r)] = r;
  dropped_ = before_->damage().dropped_records;
  writer_.emplace(StripeLogWriter::resume(options.log, before_->sound_bytes(), before_->bytes()));
}

std::optional<LoggedFrame> LoggingCapture::recorded(std::size_t i) const {
  if (!before_ || !at_[i]) return std::nullopt;
  std::optional<LoggedFrame> frame = before_->read(*at_[i]);
  require(!frame || frame->position == capture_.positions[i],
          "the stripe log '",
          before_->name(),
          "' has frame ",
          i,
          " at another axis position than this capture; continue with the recording it was begun "
          "with, or begin a new log");
  return frame;
}

/// A record as it will be read again.
LoggedFrame LoggingCapture::reread(const Bytes& record) const {
  const auto head = decode_head(record, header_);
  auto frame = head ? decode_frame(*head, ByteView(record).subspan(kRecordHeadBytes), header_)
                    : std::nullopt;
  require(frame.has_value(), "a frame of the stripe log could not be read back");
  if (header_.background == LoggedBackground::kCommon) {
    StripeWindows& windows = frame->views[0].windows;
    windows.dark = cut_windows(dark_.view(), {}, {header_.width, windows.begin}, false).lit;
  }
  return std::move(*frame);
}

MeasuredFrame LoggingCapture::measure(std::size_t i) {
  std::optional<LoggedFrame> frame = recorded(i);
  if (!frame) {
    if (before_ && at_[i]) ++dropped_;
    const Bytes record =
        encode_frame(log_frame(capture_, frames_, gate_, i, header_.width), header_);
    writer_->append(record);
    ++appended_;
    frame = reread(record);
  }
  return measure_logged(*frame, settings_.stripe, settings_);
}

LogFigures LoggingCapture::figures() const {
  LogFigures figures;
  figures.bytes = writer_->bytes();
  figures.frames = at_.size();
  figures.appended = appended_;
  figures.dropped_records = dropped_;
  figures.torn_bytes = before_ ? before_->damage().torn_bytes : 0;
  figures.raw_bytes = header_.raw_bytes(figures.frames);
  return figures;
}

}  // namespace facula
