// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/stripe/channel.hpp>

#include <cstdint>

namespace facula {

/// Row r of a grey or 3-colour frame as `channel`, that of the background taken off where there is
/// one: signed, in whole DN. With the widest instructions the processor has.
void read_signal_row(
    ImageView8 frame, ImageView8 background, int r, Channel channel, std::int16_t* values);

}  // namespace facula
