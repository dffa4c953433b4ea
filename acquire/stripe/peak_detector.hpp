// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/peak_shape.hpp>
#include <facula/acquire/stripe/row_detector.hpp>

namespace facula {

/// A profile's top, as peak_shape() found it, and where it stands.
struct Peak {
  const StripeSignal& signal;
  int r = 0;  ///< row of the signal
  const SignalRow& row;
  const PeakShape& shape;
};

/// What most detectors are: a way to place the stripe about the top of its row's profile.
class PeakDetector : public RowDetector {
 public:
  /// `sigma` is the width looked for [px].
  explicit PeakDetector(double sigma) : sigma_(sigma) {}

  std::optional<StripeCandidate> measure(const StripeSignal& signal, int r, int peak) const final;

 protected:
  double sigma() const { return sigma_; }

 private:
  /// Sets position and its noise in `found`, which describe_peak() has filled; false where there
  /// is no stripe.
  virtual bool place(const Peak& peak, StripeCandidate& found) const = 0;

  double sigma_;
};

}  // namespace facula
