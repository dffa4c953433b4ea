// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace facula {

/// The flat "key: value" lines that a map server's YAML file consists of.
struct MapYaml {
  std::string name;  ///< of the file, for messages
  std::map<std::string, std::string, std::less<>> entries;

  /// Throws Error when the line is missing.
  const std::string& text(std::string_view key) const;

  /// Of "key: 1" and of "key: [1, 2, 3]". Throws Error unless there are `count`, all finite.
  std::vector<double> numbers(std::string_view key, std::size_t count) const;
  double number(std::string_view key) const { return numbers(key, 1)[0]; }

  /// 1 and 0, true and false, as people write them.
  bool truth(std::string_view key) const;
};

/// Throws Error when the file is missing.
MapYaml read_map_yaml(const std::filesystem::path& path);

/// A YAML scalar: bare where no character could mean something, else in double quotes; and back,
/// also from single quotes, in which no character means anything.
std::string yaml_scalar(const std::string& text);
std::string yaml_text(const std::string& scalar);

/// Shortest text that reads back as the same number.
std::string exact_text(double value);

}  // namespace facula
