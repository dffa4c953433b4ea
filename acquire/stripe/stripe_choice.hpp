// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/column_gate.hpp>
#include <facula/acquire/stripe/stripe_location.hpp>

namespace facula {

/// The frame a signal was read from, for what the signal does not hold, and where to look.
struct StripeView {
  ImageView8 frame;
  ImageView8 background;             ///< may be empty
  const ColumnGate* gate = nullptr;  ///< may be absent
};

/// Whether the options or the view ask for more than the strongest peak of every row.
bool needs_choice(const StripeView& view, const StripeOptions& options);

/// In place of locate_stripe(), slower: takes up to options.max_candidates peaks per row within the
/// gate, measures each, drops those that do not stand out or are not of the laser's hue, and leaves
/// the one that the best path along the stripe passes (see stripe_path.hpp); none where it passes
/// none. Lamps, red things and mirrored stripes may be brighter in some rows than the stripe; over
/// many rows they do not go on as it does.
StripeLocation choose_stripe(const StripeSignal& signal,
                             const StripeView& view,
                             const StripeOptions& options);

}  // namespace facula
