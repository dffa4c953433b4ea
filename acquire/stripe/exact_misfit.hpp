// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/stripe/stripe_judge.hpp>
#include <facula/acquire/stripe/stripe_signal.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace facula {

/// Gives row r as far as it is known, at least `reach` columns on both sides of column c where the
/// row goes on so far. It stays valid until the next call.
using RowAbout = std::function<SignalRow(std::size_t r, int c, int reach)>;

/// Of a signal, and of a frame with the stripe across its rows, read as a signal would be.
RowAbout rows_of(const StripeSignal& signal);
RowAbout rows_of(ImageView8 frame, ImageView8 background, Channel channel);

/// The misfit of measure_misfit() for rows that were measured by filters only. Their own is quick,
/// but takes place and width from the filters: it is too large where the line is much narrower or
/// wider than they are, and too small a share of it grows with the light.
class ExactMisfit {
 public:
  ExactMisfit(RowAbout row_about, double sigma);

  /// Residual, residual_freedom and residual_share of a row that was found; freedom 0 where the row
  /// ends too near.
  StripeCandidate of(const MeasuredRows& rows, std::size_t r) const;

 private:
  RowAbout row_about_;
  double most_reach_;  ///< [px]: within what a stripe log keeps of a row
};

}  // namespace facula
