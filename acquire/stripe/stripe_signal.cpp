// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/stripe_signal.hpp>

namespace facula {
namespace {

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

void read_clipped_row(ImageView8 frame, int r, std::uint8_t* clipped) {
  const std::uint8_t* pixels = frame.row(r);
  for (int c = 0; c < frame.cols; ++c, pixels += frame.channels) {
    bool any = false;
    for (int k = 0; k < frame.channels; ++k) any = any || pixels[k] == 255;
    clipped[c] = any ? 1 : 0;
  }
}

}  // namespace

StripeSignal::StripeSignal(ImageView8 frame, ImageView8 background, Channel channel, bool transpose)
    : rows_(transpose ? frame.cols : frame.rows),
      cols_(transpose ? frame.rows : frame.cols),
      width_(cols_) {
  check_pair(frame, background);
  const std::size_t count = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_);
  values_.resize(count);
  clipped_.resize(count);
  const auto width = static_cast<std::size_t>(frame.cols);
  std::vector<std::int16_t> lit(width);
  std::vector<std::int16_t> dark(width, 0);
  std::vector<std::uint8_t> clipped(width);
  for (int r = 0; r < frame.rows; ++r) {
    read_channel_row(frame, r, channel, lit.data());
    if (!background.empty()) read_channel_row(background, r, channel, dark.data());
    read_clipped_row(frame, r, clipped.data());
    const auto row = static_cast<std::size_t>(r);
    for (std::size_t c = 0; c < width; ++c) {
      const std::size_t i = transpose ? c * static_cast<std::size_t>(cols_) + row : row * width + c;
      values_[i] = static_cast<std::int16_t>(lit[c] - dark[c]);
      clipped_[i] = clipped[c];
    }
  }
}

StripeSignal::StripeSignal(const StripeWindows& windows, Channel channel)
    : StripeSignal(windows.lit.view(), windows.dark.view(), channel, false) {
  windows.check();
  cols_ = windows.cols;
  begin_ = windows.begin;
}

}  // namespace facula
