// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/number_text.hpp>

#include <array>
#include <charconv>
#include <cmath>

namespace facula {

std::string fixed_text(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  std::array<char, 400> text{};
  const auto end = std::to_chars(
      text.data(), text.data() + text.size(), value, std::chars_format::fixed, decimals);
  std::string result(text.data(), end.ptr);
  const bool only_zeros = result.find_first_not_of("-0.") == std::string::npos;
  if (only_zeros && result.front() == '-') result.erase(0, 1);
  return result;
}

}  // namespace facula
