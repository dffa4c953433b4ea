// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_list.hpp>
#include <facula/acquire/core/error.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace facula {
namespace {

constexpr std::array<std::string_view, 6> kVideoExtensions = {
    ".avi", ".mp4", ".mkv", ".mov", ".m4v", ".webm"};

bool matches(std::string_view name, std::string_view pattern) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] == '*') {
    return matches(name, pattern.substr(1)) || (!name.empty() && matches(name.substr(1), pattern));
  }
  if (name.empty() || (pattern[0] != '?' && pattern[0] != name[0])) return false;
  return matches(name.substr(1), pattern.substr(1));
}

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// The run of digits at the front, leading zeros dropped; it is removed from `text`.
std::string_view take_digits(std::string_view& text) {
  std::size_t length = 0;
  while (length < text.size() && is_digit(text[length])) ++length;
  std::string_view digits = text.substr(0, length);
  text.remove_prefix(length);
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

/// Numbers inside names compare by value.
bool counts_before(const std::filesystem::path& first, const std::filesystem::path& second) {
  const std::string first_name = first.filename().string();
  const std::string second_name = second.filename().string();
  std::string_view a = first_name;
  std::string_view b = second_name;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a[0]) && is_digit(b[0])) {
      const std::string_view m = take_digits(a);
      const std::string_view n = take_digits(b);
      if (m != n) return m.size() != n.size() ? m.size() < n.size() : m < n;
    } else {
      if (a[0] != b[0]) return a[0] < b[0];
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return a.size() != b.size() ? a.size() < b.size() : first_name < second_name;
}

}  // namespace

std::vector<std::filesystem::path> list_frames(const std::filesystem::path& folder,
                                               const std::string& pattern) {
  const std::filesystem::path wanted = folder / pattern;
  std::filesystem::path place = wanted.parent_path();
  if (!std::filesystem::is_directory(place)) place = folder;
  require(std::filesystem::is_directory(place),
          "the frames' folder '",
          place.string(),
          "' is not there; name it with --frames");
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(place)) {
    if (entry.is_regular_file() &&
        matches(entry.path().filename().string(), wanted.filename().string())) {
      files.push_back(entry.path());
    }
  }
  require(!files.empty(),
          "no frame in '",
          place.string(),
          "' matches '",
          wanted.filename().string(),
          "'; check the pattern, or name the folder with --frames");
  std::sort(files.begin(), files.end(), counts_before);
  return files;
}

bool is_video(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) {
    return static_cast<char>(std::tolower(c));
  });
  return std::find(kVideoExtensions.begin(), kVideoExtensions.end(), extension) !=
         kVideoExtensions.end();
}

}  // namespace facula
