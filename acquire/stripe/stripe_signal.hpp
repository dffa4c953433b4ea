// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/stripe/channel.hpp>
#include <facula/acquire/stripe/stripe_windows.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace facula {

/// The part of one row that is known: columns [begin, end) of the frame.
struct SignalRow {
  const std::int16_t* values = nullptr;   ///< values[c - begin] [DN]
  const std::uint8_t* clipped = nullptr;  ///< clipped[c - begin], 1 where a colour stands at 255
  int begin = 0;                          ///< [px]
  int end = 0;                            ///< [px]

  bool empty() const { return begin >= end; }
  bool holds(int c) const { return c >= begin && c < end; }

  /// Value at a column of the frame; beyond what is known the row goes on level. Not of an empty
  /// row.
  int at(int c) const { return values[std::clamp(c, begin, end - 1) - begin]; }
  bool is_clipped(int c) const { return clipped[std::clamp(c, begin, end - 1) - begin] != 0; }
};

/// Throws Error when the frame is neither grey nor of 3 colours, or background and frame differ in
/// size or number of channels. The background may be empty.
void check_pair(ImageView8 frame, ImageView8 background);

/// The rows (or columns) of a frame as the detectors read them: one channel, background taken off,
/// as signed whole numbers, so that the noise about zero stays whole.
class StripeSignal {
 public:
  /// `background` may be empty. `transpose` turns columns into rows. Throws Error when the frame is
  /// neither grey nor of 3 colours, or background and frame differ in size or number of channels.
  StripeSignal(ImageView8 frame, ImageView8 background, Channel channel, bool transpose);

  /// The windows about the stripe alone; rows without a window are empty. Row by row the same
  /// numbers as those of the frame they were cut from.
  StripeSignal(const StripeWindows& windows, Channel channel);

  int rows() const { return rows_; }
  int cols() const { return cols_; }  ///< of the frame, also where only windows of it are known

  /// Whether every column of the frame is known.
  bool is_whole() const { return begin_.empty(); }

  SignalRow row(int r) const {
    const std::size_t start = static_cast<std::size_t>(r) * static_cast<std::size_t>(width_);
    const int begin = begin_.empty() ? 0 : begin_[static_cast<std::size_t>(r)];
    const int end = begin < 0 ? begin : begin + width_;
    return {values_.data() + start, clipped_.data() + start, begin, end};
  }

 private:
  int rows_;
  int cols_;
  int width_;                        ///< columns that are known of every row [px]
  std::vector<std::int32_t> begin_;  ///< first of them, -1 for none; empty: all begin at 0 [px]
  std::vector<std::int16_t> values_;
  std::vector<std::uint8_t> clipped_;
};

}  // namespace facula
