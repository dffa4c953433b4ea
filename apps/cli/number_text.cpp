// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/number_text.hpp>

#include <array>
#include <charconv>
#include <cmath>

namespace facula {
namespace {

constexpr double kLarge = 1e12;  // [1]

}  // namespace

std::string fixed_text(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 400> text{};
  // Stray points and typing errors shall not fill the screen with digits.
  const bool large = std::abs(value) >= kLarge;
  const auto format = large ? std::chars_format::scientific : std::chars_format::fixed;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, format, large ? 3 : decimals);
  std::string result(text.data(), end.ptr);
  const bool only_zeros = result.find_first_not_of("-0.") == std::string::npos;
  if (only_zeros && result.front() == '-') result.erase(0, 1);
  return result;
}

}  // namespace facula
