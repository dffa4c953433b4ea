// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/number_format.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace facula {
namespace {

constexpr int kMostDecimals = 15;

/// Decimals that show `digits` significant digits of the value.
int decimals_for(double value, int digits) {
  if (value == 0) return 0;
  const int magnitude = static_cast<int>(std::floor(std::log10(std::abs(value))));
  const int decimals = digits - 1 - magnitude;
  // 9.996 with 3 digits rounds to 10.0, one digit more than asked for.
  const double rounded = std::round(std::abs(value) * std::pow(10.0, decimals));
  const int carry = rounded >= std::pow(10.0, digits) ? 1 : 0;
  return std::clamp(decimals - carry, 0, kMostDecimals);
}

/// 1, 2 or 5 times a power of ten, not below `step`.
double round_step(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  const double share = step / power;
  if (share <= 1.0001) return power;
  if (share <= 2.0001) return 2 * power;
  if (share <= 5.0001) return 5 * power;
  return 10 * power;
}

}  // namespace

LengthUnit length_unit_for(double largest) {
  const double size = std::abs(largest);
  if (size >= 1.0) return {"m", 1};
  if (size >= 1e-3 || !(size > 0)) return {"mm", 1e3};
  return {"µm", 1e6};
}

std::string format_fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "n/a";
  std::array<char, 400> text;
  const int places = std::clamp(decimals, 0, kMostDecimals);
  const auto end = std::to_chars(
      text.data(), text.data() + text.size(), value, std::chars_format::fixed, places);
  std::string number(text.data(), end.ptr);
  if (number.find_first_not_of("-0.") == std::string::npos && number[0] == '-') number.erase(0, 1);
  return number;
}

std::string format_significant(double value, int digits) {
  if (!std::isfinite(value)) return "n/a";
  return format_fixed(value, decimals_for(value, digits));
}

std::string format_length(double metres, int digits) {
  if (!std::isfinite(metres)) return "n/a";
  const LengthUnit unit = length_unit_for(metres);
  return format_significant(metres * unit.per_metre, digits) + " " + unit.name;
}

std::string format_count(std::size_t count) {
  std::string text = std::to_string(count);
  for (std::size_t place = text.size(); place > 3; place -= 3) text.insert(place - 3, 1, ' ');
  return text;
}

std::vector<double> round_ticks(double low, double high, int count) {
  if (!std::isfinite(low) || !std::isfinite(high) || !(high > low) || count < 1) return {};
  const double step = round_step((high - low) / count);
  if (!std::isnormal(step)) return {};
  const double slack = step * 1e-6;
  std::vector<double> ticks;
  for (double k = std::ceil((low - slack) / step); k * step <= high + slack; k += 1) {
    if (ticks.size() > 2 * static_cast<std::size_t>(count)) return {};  // beyond double's digits
    ticks.push_back(k * step);
  }
  return ticks;
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  int decimals = 0;
  if (ticks.size() > 1) {
    const double step = ticks[1] - ticks[0];
    decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-6)));
  }
  std::vector<std::string> labels;
  labels.reserve(ticks.size());
  for (const double tick : ticks) {
    labels.push_back(ticks.size() > 1 ? format_fixed(tick, decimals) : format_significant(tick, 4));
  }
  return labels;
}

}  // namespace facula
