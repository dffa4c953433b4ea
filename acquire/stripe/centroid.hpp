// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/stripe/row_detector.hpp>

#include <memory>

namespace facula {

/// Source B's spot centre (2.3): the middle between the first and the last brightest pixel of the
/// row, then the mean of I(x) x over +-10 px about it. I(x) is taken over the row's median, since a
/// pedestal left in the weights pulls the mean towards the window's middle.
std::unique_ptr<RowDetector> make_centroid();

}  // namespace facula
