// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/toml_text.hpp>

namespace facula {

std::string toml_quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    constexpr char kHex[] = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      result += std::string("\\u00") + kHex[byte >> 4] + kHex[byte & 15];
    } else {
      if (c == '"' || c == '\\') result += '\\';
      result += c;
    }
  }
  return result + '"';
}

}  // namespace facula
