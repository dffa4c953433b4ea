// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/signal_row.hpp>
#include <facula/acquire/stripe/stripe_signal.hpp>
#include <facula/acquire/stripe/transposed.hpp>

namespace facula {
namespace {

void read_clipped_row(ImageView8 frame, int r, std::uint8_t* clipped) {
  const std::uint8_t* p = frame.row(r);
  if (frame.channels == 1) {
    for (int c = 0; c < frame.cols; ++c) clipped[c] = p[c] == 255 ? 1 : 0;
    return;
  }
  for (int c = 0; c < frame.cols; ++c, p += 3) {
    clipped[c] = static_cast<std::uint8_t>(int{p[0] == 255} | int{p[1] == 255} | int{p[2] == 255});
  }
}

}  // namespace

void check_pair(ImageView8 frame, ImageView8 background) {
  require(frame.empty() || frame.channels == 1 || frame.channels == 3,
          "expected a grey frame or one of 3 colours, got ",
          frame.channels,
          " channels");
  require(background.empty() || background.channels == frame.channels,
          "expected frame and background both grey or both in colour, got ",
          frame.channels,
          " and ",
          background.channels,
          " channels");
  require(background.empty() || (background.rows == frame.rows && background.cols == frame.cols),
          "expected a background of the frame's size ",
          frame.cols,
          " x ",
          frame.rows,
          ", got ",
          background.cols,
          " x ",
          background.rows);
}

StripeSignal::StripeSignal(ImageView8 frame, ImageView8 background, Channel channel, bool transpose)
    : rows_(transpose ? frame.cols : frame.rows),
      cols_(transpose ? frame.rows : frame.cols),
      width_(cols_) {
  check_pair(frame, background);
  const Image8 turned = transpose ? transposed(frame) : Image8();
  const Image8 turned_dark = transpose && !background.empty() ? transposed(background) : Image8();
  const ImageView8 lit = transpose ? turned.view() : frame;
  const ImageView8 dark = transpose ? turned_dark.view() : background;
  const auto width = static_cast<std::size_t>(cols_);
  values_.resize(static_cast<std::size_t>(rows_) * width);
  clipped_.resize(values_.size());
  for (int r = 0; r < rows_; ++r) {
    const std::size_t start = static_cast<std::size_t>(r) * width;
    read_signal_row(lit, dark, r, channel, values_.data() + start);
    read_clipped_row(lit, r, clipped_.data() + start);
  }
}

StripeSignal::StripeSignal(const StripeWindows& windows, Channel channel)
    : StripeSignal(windows.lit.view(), windows.dark.view(), channel, false) {
  windows.check();
  cols_ = windows.cols;
  begin_ = windows.begin;
}

}  // namespace facula
