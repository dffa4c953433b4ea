// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_detector.hpp>
#include <facula/apps/report/drawing.hpp>

namespace facula {

/// The frame with the found stripe drawn over it to a fraction of a pixel (small frames enlarged,
/// large ones reduced). Rows without a stripe are marked in a narrow strip beside the frame; a line
/// below says how many. Throws Error when the profile's length is not the frame's number of rows
/// (of columns for kPerColumn).
Image8 stripe_over_frame(ImageView8 frame,
                         const StripeProfile& profile,
                         StripeDirection direction = StripeDirection::kPerRow);

}  // namespace facula
