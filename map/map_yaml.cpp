// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/whole_file.hpp>
#include <facula/map/map_yaml.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

namespace facula {
namespace {

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

/// The line without a comment, which begins with # at its start or behind a space, but not between
/// quotes.
std::string without_comment(const std::string& line) {
  char quote = 0;  // the one that is open
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    const bool begins_word = i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t';
    if (quote == '"' && c == '\\')
      ++i;
    else if (quote != 0)
      quote = c == quote ? char{0} : quote;
    else if (begins_word && (c == '"' || c == '\''))
      quote = c;
    else if (begins_word && c == '#')
      return line.substr(0, i);
  }
  return line;
}

/// Numbers of "[1, 2, 3]" or "1"; none where one is malformed or not finite.
std::vector<double> listed(const std::string& text) {
  std::vector<double> values;
  const char* at = text.data();
  const char* end = at + text.size();
  while (at != end) {
    if (*at == '[' || *at == ',' || *at == ' ' || *at == ']') {
      ++at;
      continue;
    }
    double value = 0;
    const auto [next, failure] = std::from_chars(at, end, value);
    if (failure != std::errc() || !std::isfinite(value)) return {};
    values.push_back(value);
    at = next;
  }
  return values;
}

}  // namespace

const std::string& MapYaml::text(std::string_view key) const {
  const auto found = entries.find(key);
  require(found != entries.end(), "'", name, "': expected a line '", key, ": ...'");
  return found->second;
}

std::vector<double> MapYaml::numbers(std::string_view key, std::size_t count) const {
  std::vector<double> values = listed(text(key));
  require(values.size() == count,
          "'",
          name,
          "': expected ",
          count,
          count == 1 ? " number after '" : " numbers after '",
          key,
          ":'");
  return values;
}

bool MapYaml::truth(std::string_view key) const {
  std::string word = text(key);
  std::transform(word.begin(), word.end(), word.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (word == "true" || word == "yes" || word == "on") return true;
  if (word == "false" || word == "no" || word == "off") return false;
  return number(key) != 0;
}

MapYaml read_map_yaml(const std::filesystem::path& path) {
  MapYaml yaml{path.string(), {}};
  std::istringstream lines(read_whole_file(path));
  for (std::string line; std::getline(lines, line);) {
    line = without_comment(line);
    const auto colon = line.find(':');
    if (colon == std::string::npos) continue;
    yaml.entries[trimmed(std::string_view(line).substr(0, colon))] =
        trimmed(std::string_view(line).substr(colon + 1));
  }
  return yaml;
}

std::string yaml_scalar(const std::string& text) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '.' || c == '/';
  };
  if (std::all_of(text.begin(), text.end(), is_plain)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string yaml_text(const std::string& scalar) {
  if (scalar.size() > 1 && scalar.front() == '\'' && scalar.back() == '\'') {
    return scalar.substr(1, scalar.size() - 2);
  }
  if (scalar.size() < 2 || scalar.front() != '"' || scalar.back() != '"') return scalar;
  std::string plain;
  for (std::size_t i = 1; i + 1 < scalar.size(); ++i) {
    if (scalar[i] == '\\' && i + 2 < scalar.size()) ++i;
    plain += scalar[i];
  }
  return plain;
}

std::string exact_text(double value) {
  std::array<char, 64> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace facula
