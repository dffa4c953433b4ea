// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/row_detector.hpp>
#include <facula/acquire/stripe/stripe_detector.hpp>

#include <memory>

namespace facula {

/// The detector that the options ask for.
std::unique_ptr<RowDetector> make_detector(const StripeOptions& options);

}  // namespace facula
