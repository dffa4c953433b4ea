// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/log/log_record.hpp>

#include <cmath>
#include <cstring>
#include <utility>

namespace facula {
namespace {

constexpr std::uint32_t kRecordMagic = 0xF1A5C0DE;
constexpr std::uint16_t kNoWindow = 0xFFFF;
constexpr std::uint8_t kNoPeak = 0xFF;

std::size_t longest_payload(RecordKind kind, const StripeLogHeader& h) {
  if (kind == RecordKind::kBackground) return h.frame_bytes();
  const std::size_t pixels =
      static_cast<std::size_t>(h.width) * static_cast<std::size_t>(h.channels);
  const std::size_t row = 7 + pixels * (h.background == LoggedBackground::kPerFrame ? 2 : 1);
  return 16 + static_cast<std::size_t>(h.views()) * (8 + static_cast<std::size_t>(h.rows) * row);
}

/// Puts the head in front of a payload that begins kRecordHeadBytes into `record`.
void fill_head(Bytes& record, RecordKind kind, std::uint64_t index) {
  const ByteView payload = ByteView(record).subspan(kRecordHeadBytes);
  put_at(record, 0, kRecordMagic);
  put_at(record, 4, static_cast<std::uint32_t>(kind));
  put_at(record, 8, index);
  put_at(record, 16, static_cast<std::uint32_t>(payload.size()));
  put_at(record, 20, crc32_of(payload));
  put_at(record, 24, crc32_of(ByteView(record).first(24)));
}

void put_pixels(Bytes& out, const Image8& image, const std::vector<std::int32_t>& begin) {
  for (std::size_t r = 0; r < begin.size() && !image.empty(); ++r) {
    if (begin[r] < 0) continue;
    put_bytes(out, image.row(static_cast<int>(r)), static_cast<std::size_t>(image.stride()));
  }
}

void put_view(Bytes& out, const LoggedView& view, bool with_dark) {
  const StripeWindows& windows = view.windows;
  put(out, view.location.noise);
  put(out, static_cast<std::uint32_t>(windows.kept_rows()));
  for (const std::int32_t first : windows.begin) {
    put(out, first < 0 ? kNoWindow : static_cast<std::uint16_t>(first));
  }
  for (std::size_t r = 0; r < windows.begin.size(); ++r) {
    if (windows.begin[r] >= 0) put(out, view.location.row_noise[r]);
  }
  for (std::size_t r = 0; r < windows.begin.size(); ++r) {
    const std::int32_t first = windows.begin[r];
    if (first < 0) continue;
    const std::int32_t peak = view.location.peak[r];
    const bool held = peak >= first && peak < first + windows.width();
    put(out, held ? static_cast<std::uint8_t>(peak - first) : kNoPeak);
  }
  put_pixels(out, windows.lit, windows.begin);
  if (with_dark) put_pixels(out, windows.dark, windows.begin);
}

Image8 take_pixels(ByteReader& in,
                   const std::vector<std::int32_t>& begin,
                   const StripeLogHeader& h) {
  Image8 image(h.rows, h.width, h.channels);
  const auto size = static_cast<std::size_t>(image.stride());
  for (std::size_t r = 0; r < begin.size(); ++r) {
    if (begin[r] >= 0) in.take_bytes(image.row(static_cast<int>(r)), size);
  }
  return image;
}

/// Window beginnings; none when one leaves the frame or their number is not as stated.
std::optional<std::vector<std::int32_t>> take_begins(ByteReader& in,
                                                     std::uint32_t kept,
                                                     const StripeLogHeader& h) {
  std::vector<std::int32_t> begin(static_cast<std::size_t>(h.rows), -1);
  std::uint32_t count = 0;
  for (std::int32_t& first : begin) {
    const auto stored = in.take<std::uint16_t>();
    if (stored == kNoWindow) continue;
    if (stored + h.width > h.cols) return std::nullopt;
    first = stored;
    ++count;
  }
  if (count != kept) return std::nullopt;
  return begin;
}

std::optional<LoggedView> take_view(ByteReader& in, bool with_dark, const StripeLogHeader& h) {
  LoggedView view;
  view.location = StripeLocation::none(static_cast<std::size_t>(h.rows));
  view.location.noise = in.take<float>();
  const auto kept = in.take<std::uint32_t>();
  auto begin = take_begins(in, kept, h);
  if (!begin) return std::nullopt;
  for (std::size_t r = 0; r < begin->size(); ++r) {
    if ((*begin)[r] >= 0) view.location.row_noise[r] = in.take<float>();
  }
  for (std::size_t r = 0; r < begin->size(); ++r) {
    if ((*begin)[r] < 0) continue;
    const auto offset = in.take<std::uint8_t>();
    if (offset == kNoPeak) continue;
    if (offset >= h.width) return std::nullopt;
    view.location.peak[r] = (*begin)[r] + offset;
  }
  view.windows.cols = h.cols;
  view.windows.lit = take_pixels(in, *begin, h);
  if (with_dark) view.windows.dark = take_pixels(in, *begin, h);
  view.windows.begin = std::move(*begin);
  if (in.failed()) return std::nullopt;
  return view;
}

bool with_dark(const StripeLogHeader& header, std::size_t view) {
  return view < static_cast<std::size_t>(header.exposures) &&
         header.background == LoggedBackground::kPerFrame;
}

void check_frame(const LoggedFrame& frame, const StripeLogHeader& header) {
  require(frame.views.size() == static_cast<std::size_t>(header.views()),
          "expected ",
          header.views(),
          " images per frame as the stripe log's header says, got ",
          frame.views.size());
  for (std::size_t v = 0; v < frame.views.size(); ++v) {
    const StripeWindows& w = frame.views[v].windows;
    w.check();
    require(w.rows() == header.rows && w.cols == header.cols && w.width() == header.width &&
                w.lit.channels == header.channels &&
                frame.views[v].location.size() == static_cast<std::size_t>(header.rows) &&
                (!with_dark(header, v) || !w.dark.empty()),
            "frame ",
            frame.index,
            ": expected frames of the stripe log's size and channels (",
            header.rows,
            " rows of ",
            header.cols,
            " px, ",
            header.channels,
            " channels), got ",
            w.rows(),
            " rows of ",
            w.cols,
            " px, ",
            w.lit.channels,
            " channels");
  }
}

}  // namespace

std::optional<RecordHead> decode_head(ByteView bytes, const StripeLogHeader& header) {
  if (bytes.size() < kRecordHeadBytes) return std::nullopt;
  ByteReader in(bytes.first(kRecordHeadBytes));
  if (in.take<std::uint32_t>() != kRecordMagic) return std::nullopt;
  const auto kind = in.take<std::uint32_t>();
  RecordHead head;
  head.kind = static_cast<RecordKind>(kind);
  head.index = in.take<std::uint64_t>();
  head.payload = in.take<std::uint32_t>();
  head.checksum = in.take<std::uint32_t>();
  if (in.take<std::uint32_t>() != crc32_of(bytes.first(24)) || kind > 1) return std::nullopt;
  if (head.payload > longest_payload(head.kind, header)) return std::nullopt;
  return head;
}

Bytes encode_frame(const LoggedFrame& frame, const StripeLogHeader& header) {
  check_frame(frame, header);
  Bytes out;
  out.reserve(kRecordHeadBytes + longest_payload(RecordKind::kFrame, header));
  out.resize(kRecordHeadBytes);
  put(out, frame.position);
  put(out, frame.time);
  for (std::size_t v = 0; v < frame.views.size(); ++v) {
    put_view(out, frame.views[v], with_dark(header, v));
  }
  fill_head(out, RecordKind::kFrame, frame.index);
  return out;
}

Bytes encode_background(ImageView8 frame) {
  Bytes out(kRecordHeadBytes);
  for (int r = 0; r < frame.rows; ++r) {
    put_bytes(out,
              frame.row(r),
              static_cast<std::size_t>(frame.cols) * static_cast<std::size_t>(frame.channels));
  }
  fill_head(out, RecordKind::kBackground, 0);
  return out;
}

std::optional<LoggedFrame> decode_frame(const RecordHead& head,
                                        ByteView payload,
                                        const StripeLogHeader& header) {
  if (head.kind != RecordKind::kFrame || payload.size() != head.payload ||
      crc32_of(payload) != head.checksum) {
    return std::nullopt;
  }
  ByteReader in(payload);
  LoggedFrame frame;
  frame.index = head.index;
  frame.position = in.take<double>();
  frame.time = in.take<double>();
  for (std::size_t v = 0; v < static_cast<std::size_t>(header.views()); ++v) {
    auto view = take_view(in, with_dark(header, v), header);
    if (!view) return std::nullopt;
    frame.views.push_back(std::move(*view));
  }
  if (in.failed() || in.left() != 0 || !std::isfinite(frame.position) ||
      !std::isfinite(frame.time)) {
    return std::nullopt;
  }
  return frame;
}

std::optional<Image8> decode_background(const RecordHead& head,
                                        ByteView payload,
                                        const StripeLogHeader& header) {
  if (head.kind != RecordKind::kBackground || payload.size() != head.payload ||
      payload.size() != header.frame_bytes() || crc32_of(payload) != head.checksum) {
    return std::nullopt;
  }
  Image8 image(header.rows, header.cols, header.channels);
  std::memcpy(image.pixels.data(), payload.data(), payload.size());
  return image;
}

}  // namespace facula
