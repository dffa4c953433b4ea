// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace facula {

/// A unit lengths are shown in.
struct LengthUnit {
  const char* name = "m";  ///< "m", "mm" or "µm"
  double per_metre = 1;    ///< [1/m]
};

/// The unit in which `largest` [m] has a readable size.
LengthUnit length_unit_for(double largest);

/// "-12.30": fixed decimals, a point whatever the locale, no "-0.00"; "n/a" when not finite.
std::string format_fixed(double value, int decimals);

/// A number with `digits` significant digits, without exponent: 0.01234 with 3 is "0.0123".
std::string format_significant(double value, int digits = 3);

/// A length [m] with its unit: "12.3 mm", "-45.6 µm", "3.21 m".
std::string format_length(double metres, int digits = 3);

/// A count in groups of three digits: "1 080 000".
std::string format_count(std::size_t count);

/// Round values (1, 2 or 5 times a power of ten apart) within [low, high], about `count` of them;
/// none when the range is empty or not finite.
std::vector<double> round_ticks(double low, double high, int count);

/// Labels of round_ticks(), all with the decimals their step needs.
std::vector<std::string> tick_labels(const std::vector<double>& ticks);

}  // namespace facula
