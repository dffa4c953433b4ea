// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/peak_detector.hpp>

namespace facula {

std::optional<StripeCandidate> PeakDetector::measure(const StripeSignal& signal,
                                                     int r,
                                                     int peak) const {
  const SignalRow row = signal.row(r);
  const auto shape = peak_shape(row, peak, sigma_);
  if (!shape) return std::nullopt;
  auto found = describe_peak(row, *shape);
  if (!found || !place({signal, r, row, *shape}, *found)) return std::nullopt;
  return found;
}

}  // namespace facula
