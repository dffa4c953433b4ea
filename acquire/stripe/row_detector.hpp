// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/stripe_candidate.hpp>
#include <facula/acquire/stripe/stripe_signal.hpp>

#include <optional>

namespace facula {

/// What a detector is: a way to measure the stripe at a place where something like one was located
/// (see locate.hpp). One file pair each, one row each in detector_table.cpp. Calls may run from
/// several threads.
class RowDetector {
 public:
  RowDetector() = default;
  virtual ~RowDetector() = default;
  RowDetector(const RowDetector&) = delete;
  RowDetector& operator=(const RowDetector&) = delete;

  /// The stripe of row r about column `peak`, which the row holds; none where there is none. Fills
  /// everything but row_noise.
  virtual std::optional<StripeCandidate> measure(const StripeSignal& signal,
                                                 int r,
                                                 int peak) const = 0;
};

}  // namespace facula
