// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_choice.hpp>
#include <facula/acquire/stripe/stripe_location.hpp>
#include <facula/acquire/stripe/stripe_windows.hpp>

#include <cstddef>
#include <vector>

namespace facula {

/// One image of a log: the windows about the stripe, and what was found out from the columns that
/// are not kept.
struct LoggedView {
  StripeLocation location;
  StripeWindows windows;
};

/// One record of a stripe log.
struct LoggedFrame {
  std::size_t index = 0;          ///< of the frame, counted from 0
  double position = 0;            ///< of the axis [rad or m]
  double time = 0;                ///< since the first frame [s]
  std::vector<LoggedView> views;  ///< the scene; the bare bed where there is a zero line
};

/// Locates the stripe in a whole frame as detect_stripe() does and keeps windows of `width` about
/// it. The result tells what a log can hold of it: peaks outside of their row's window are dropped.
/// Throws Error as detect_stripe() does.
LoggedView log_view(const StripeView& images, const StripeOptions& options, int width);

/// The stripe, from the windows alone. `logged` are the options it was located with: where another
/// channel, line width or region is asked for, it is located again, by the strongest peak within
/// each window, and the noise of frame and rows is that of the windows.
StripeProfile measure_view(const LoggedView& view,
                           const StripeOptions& logged,
                           const StripeOptions& options);

}  // namespace facula
