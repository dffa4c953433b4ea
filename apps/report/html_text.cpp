// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/html_text.hpp>

#include <array>
#include <cctype>
#include <cstddef>
#include <string_view>

namespace facula {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr std::size_t kLongestUnit = 10;                   // [bytes]

/// Length of the well-formed UTF-8 sequence at the front of `text` (Unicode 15, table 3-7); 0 when
/// there is none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  if (lead < 0x80) return 1;
  std::size_t length = 0;
  if (lead >= 0xC2 && lead <= 0xDF) length = 2;
  if (lead >= 0xE0 && lead <= 0xEF) length = 3;
  if (lead >= 0xF0 && lead <= 0xF4) length = 4;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return 0;
  }
  const unsigned char second = byte(1);
  const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
  const bool surrogate = lead == 0xED && second > 0x9F;
  const bool too_large = lead == 0xF4 && second > 0x8F;
  return overlong || surrogate || too_large ? 0 : length;
}

void append_escaped(std::string& html, char sign) {
  switch (sign) {
    case '&':
      html += "&amp;";
      break;
    case '<':
      html += "&lt;";
      break;
    case '>':
      html += "&gt;";
      break;
    case '"':
      html += "&quot;";
      break;
    case '\'':
      html += "&#39;";
      break;
    default:
      if (static_cast<unsigned char>(sign) >= 0x20 || sign == '\t' || sign == '\n') html += sign;
  }
}

void skip_spaces(std::string_view& text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
}

void skip_sign(std::string_view& text) {
  constexpr std::array<std::string_view, 8> kSigns{"+", "-", "\u2212", "±", "<", ">", "≤", "≥"};
  for (const std::string_view sign : kSigns) {
    if (!text.starts_with(sign)) continue;
    text.remove_prefix(sign.size());
    break;
  }
  skip_spaces(text);
}

std::size_t skip_digits(std::string_view& text) {
  std::size_t digits = 0;
  while (!text.empty()) {
    const bool digit = std::isdigit(static_cast<unsigned char>(text.front())) != 0;
    const bool grouping = digits > 0 && text.size() > 1 && text.front() == ' ' &&
                          std::isdigit(static_cast<unsigned char>(text[1])) != 0;
    if (!digit && !grouping) break;
    digits += digit ? 1 : 0;
    text.remove_prefix(1);
  }
  return digits;
}

/// Takes a number off the front; false when there is none.
bool skip_number(std::string_view& text) {
  skip_sign(text);
  std::size_t digits = skip_digits(text);
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    digits += skip_digits(text);
  }
  if (digits == 0) return false;
  std::string_view exponent = text;
  if (exponent.starts_with('e') || exponent.starts_with('E')) {
    exponent.remove_prefix(1);
    skip_sign(exponent);
    if (skip_digits(exponent) > 0) text = exponent;
  }
  return true;
}

}  // namespace

std::string html_escaped(const std::string& text) {
  std::string html;
  html.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = sequence_length(std::string_view(text).substr(i));
    if (length == 1) append_escaped(html, text[i]);
    if (length > 1) html.append(text, i, length);
    if (length == 0) html += kReplacement;
    i += length == 0 ? 1 : length;
  }
  return html;
}

std::string html_paragraphs(const std::string& text) {
  std::string html;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = text.find("\n\n", begin);
    if (end == std::string::npos) end = text.size();
    const std::string paragraph = text.substr(begin, end - begin);
    if (paragraph.find_first_not_of(" \t\r\n") != std::string::npos) {
      html += "<p>" + html_escaped(paragraph) + "</p>\n";
    }
    begin = end + 2;
  }
  return html;
}

bool is_figure(const std::string& cell) {
  std::string_view rest = cell;
  skip_spaces(rest);
  if (rest == "-" || rest == "–" || rest == "n/a") return true;
  if (!skip_number(rest)) return false;
  skip_spaces(rest);
  if (rest.starts_with("±") && !skip_number(rest)) return false;
  skip_spaces(rest);
  // What is left is a unit: short, one word, without digits in front ("2026-01-31" is no figure).
  return rest.size() <= kLongestUnit && rest.find(' ') == std::string_view::npos &&
         !rest.starts_with('-') && !rest.starts_with(':') && !rest.starts_with('.');
}

}  // namespace facula
