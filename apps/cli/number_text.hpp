// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace facula {

/// A number with a fixed count of decimals, with a point whatever the locale; "-" when not finite.
std::string fixed_text(double value, int decimals);

}  // namespace facula
