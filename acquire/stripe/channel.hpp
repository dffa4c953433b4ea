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
  kGrey,         ///< 0.299 R + 0.587 G + 0.114 B (ITU-R BT.601), the weights in 256ths
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

/// Reads one row of a grey or 3-colour frame as `channel`, signed, in whole DN.
void read_channel_row(ImageView8 frame, int r, Channel channel, std::int16_t* values);

}  // namespace facula
