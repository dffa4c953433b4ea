// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/log/log_bytes.hpp>
#include <facula/acquire/log/log_header.hpp>
#include <facula/acquire/log/logged_frame.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>

namespace facula {

enum class RecordKind : std::uint32_t { kFrame = 0, kBackground = 1 };

inline constexpr std::size_t kRecordHeadBytes = 28;

/// The first bytes of a record; they have a checksum of their own, so that a record whose contents
/// are damaged can be stepped over.
struct RecordHead {
  RecordKind kind = RecordKind::kFrame;
  std::uint64_t index = 0;     ///< of the frame
  std::size_t payload = 0;     ///< bytes that follow
  std::uint32_t checksum = 0;  ///< of those
};

/// None unless the first kRecordHeadBytes bytes are a sound head of a record that may stand in a
/// log with this header.
std::optional<RecordHead> decode_head(ByteView bytes, const StripeLogHeader& header);

/// Whole records, head and payload. The frame must be one of this log: its sizes are the header's.
Bytes encode_frame(const LoggedFrame& frame, const StripeLogHeader& header);
Bytes encode_background(ImageView8 frame);

/// The frame in a payload; none when checksum or contents are wrong. Common backgrounds are not
/// filled in.
std::optional<LoggedFrame> decode_frame(const RecordHead& head,
                                        ByteView payload,
                                        const StripeLogHeader& header);
std::optional<Image8> decode_background(const RecordHead& head,
                                        ByteView payload,
                                        const StripeLogHeader& header);

}  // namespace facula
