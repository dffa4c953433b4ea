// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace facula {

/// A number with a fixed count of decimals, with a point whatever the locale; "-" when not finite;
/// with an exponent from 1e12 on.
std::string fixed_text(double value, int decimals);

}  // namespace facula
