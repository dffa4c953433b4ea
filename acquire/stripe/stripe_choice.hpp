// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/column_gate.hpp>
#include <facula/acquire/stripe/stripe_location.hpp>

namespace facula {

/// A frame with everything that says where its stripe may be.
struct StripeView {
  ImageView8 frame;
  ImageView8 background = {};        ///< may be empty
  const ColumnGate* gate = nullptr;  ///< columns that may hold it; may be absent
  ImageView8 moving = {};            ///< see moving_pixels.hpp; may be empty
};

/// Whether the options ask for more than the strongest peak of every row.
bool asks_for_choice(const StripeOptions& options);

/// Whether the options or the view ask for it: then choose_stripe() locates, else locate_stripe().
bool needs_choice(const StripeView& view, const StripeOptions& options);

/// detect_stripe() of a view. Throws Error as that does, or when gate or moving pixels do not fit
/// the frame.
StripeProfile detect_stripe(const StripeView& view, const StripeOptions& options);

/// In place of locate_stripe(), slower: takes up to options.max_candidates peaks per row within the
/// gate, measures each, drops those that do not stand out, are not of the laser's hue or touch a
/// pixel that moved, and leaves the one that the best path along the stripe passes (see
/// stripe_path.hpp); none where it passes none. Lamps, red things and mirrored stripes may be
/// brighter in some rows than the stripe; over many rows they do not go on as it does.
StripeLocation choose_stripe(const StripeSignal& signal,
                             const StripeView& view,
                             const StripeOptions& options);

}  // namespace facula
