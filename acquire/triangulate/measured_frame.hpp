// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/log/logged_frame.hpp>
#include <facula/acquire/stripe/column_gate.hpp>

#include <cstddef>

namespace facula {

/// The stripe of one frame, ready to become a column of the scan.
struct MeasuredFrame {
  std::size_t index = 0;  ///< of the frame
  double position = 0;    ///< of the axis [rad or m]
  double time = 0;        ///< since the first frame [s]
  StripeProfile profile;  ///< against the bare bed, with a zero line
  double bed_shift = 0;   ///< of that [px]
};

/// The images of one frame, of several exposures the first; what the capture does not have is
/// empty.
struct FrameImages {
  CapturedFrame scene;
  Image8 bed;  ///< of the zero line
};

/// Throws Error when one cannot be read or is not of the camera's size.
FrameImages read_images(const Capture& capture, const CaptureFrames& frames, std::size_t i);

/// Measures frame i of a capture within the columns of `gate` (see sheet_gate.hpp), the exposures
/// of a bracket merged. Throws Error as read_images() and detect_stripe() do.
MeasuredFrame measure_frame(const Capture& capture,
                            const CaptureFrames& frames,
                            const ColumnGate& gate,
                            std::size_t i);

/// The record of frame i of a capture, its windows `width` wide [px].
LoggedFrame log_frame(const Capture& capture,
                      const CaptureFrames& frames,
                      const ColumnGate& gate,
                      std::size_t i,
                      int width);

/// Measures the record of a frame that was located with the options `logged`, see measure_view().
MeasuredFrame measure_logged(const LoggedFrame& frame,
                             const StripeOptions& logged,
                             const Capture& capture);

}  // namespace facula
