// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace facula {

/// Which number is made of a colour pixel.
enum class Channel {
  kGrey,         ///< 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601)
  kRed,          ///< R
  kGreen,        ///< G
  kBlue,         ///< B
  kRedExcess,    ///< R - max(G, B), at least 0: red light only, white light gone
  kGreenExcess,  ///< G - max(R, B), at least 0
  kBlueExcess,   ///< B - max(R, G), at least 0
  kMaximum       ///< max(R, G, B)
};

/// "grey", "red", "green", "blue", "red-excess", "green-excess", "blue-excess" or "maximum".
Channel channel_from_name(const std::string& name);
std::string to_string(Channel channel);

/// One channel of a frame; a grey frame is returned as it is, whatever the channel. Throws Error
/// for any other number of channels than 1 or 3.
Image8 extract_channel(ImageView8 frame, Channel channel);

/// The rows (or columns) of a frame as the detectors read them: one channel, background taken off,
/// as signed numbers, so that the noise about zero stays whole.
class StripeSignal {
 public:
  /// `background` may be empty. `transpose` turns columns into rows. Throws Error when the frame is
  /// neither grey nor of 3 colours, or background and frame differ in size or number of channels.
  StripeSignal(ImageView8 frame, ImageView8 background, Channel channel, bool transpose);

  int rows() const { return rows_; }
  int cols() const { return cols_; }
  const float* row(int r) const {
    return values_.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(cols_);
  }

  /// Whether any colour of the pixel is clipped at 255.
  bool clipped(int r, int c) const {
    return clipped_[static_cast<std::size_t>(r) * static_cast<std::size_t>(cols_) +
                    static_cast<std::size_t>(c)] != 0;
  }

 private:
  int rows_;
  int cols_;
  std::vector<float> values_;
  std::vector<std::uint8_t> clipped_;
};

}  // namespace facula
