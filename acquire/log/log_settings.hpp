// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/log/log_header.hpp>

#include <string>

namespace facula {

/// The header of a log of this capture, frames of `channels`: the rig as text (the bytes of its
/// file, where that still says the same as capture.rig) and all settings but frames and positions.
StripeLogHeader header_of(const Capture& capture, int channels);

/// The capture a header tells of, without frames and positions; `zero_line` has no frames either.
/// `name` is what complaints call the log. Throws Error where the texts cannot be read.
Capture capture_of(const StripeLogHeader& header, const std::string& name);

/// Throws Error, with a sentence for what differs (rig, frame size, settings, number of frames),
/// unless a log with header `found` can be continued where one with header `wanted` is needed.
void check_same_recording(const StripeLogHeader& found,
                          const StripeLogHeader& wanted,
                          const std::string& name);

}  // namespace facula
