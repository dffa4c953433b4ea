// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A table of a TOML file that is read key by key and knows which keys were asked for. Every
/// complaint names the file and the key. Call finish() at the end: it throws Error on the first key
/// nobody asked for and suggests the nearest one that was.
class TomlTable {
 public:
  /// Parses a file. Throws Error when it is missing or not TOML (with line and column).
  static TomlTable from_file(const std::filesystem::path& path);

  /// Parses a text; `source` is what complaints call it.
  static TomlTable from_text(const std::string& text, const std::string& source);

  TomlTable(TomlTable&&) noexcept;
  TomlTable& operator=(TomlTable&&) noexcept;
  ~TomlTable();

  bool has(const std::string& key) const;

  // Required values. Numbers must be finite; integers are accepted where a number is asked for.
  double number(const std::string& key);
  int integer(const std::string& key);
  std::string text(const std::string& key);
  std::vector<double> numbers(const std::string& key);
  Eigen::Vector3d vector3(const std::string& key);

  // Optional values.
  std::optional<double> number_if(const std::string& key);
  std::optional<int> integer_if(const std::string& key);
  std::optional<std::string> text_if(const std::string& key);
  std::optional<bool> boolean_if(const std::string& key);
  std::optional<Eigen::Vector3d> vector3_if(const std::string& key);

  /// A list of pairs of finite numbers, as in [[0, 10], [20, 30]]; empty when the key is absent.
  std::vector<Eigen::Vector2d> pairs(const std::string& key);

  /// A list of texts, and a list of lists of finite numbers. Throw Error when the key is absent.
  std::vector<std::string> texts(const std::string& key);
  std::vector<std::vector<double>> number_rows(const std::string& key);

  /// A table below this one.
  TomlTable table(const std::string& key);
  std::optional<TomlTable> table_if(const std::string& key);

  /// All [[key]] tables; empty when there are none.
  std::vector<TomlTable> tables(const std::string& key);

  /// The pose in `translation_mm` and either `rotation` (nine numbers, row by row) or
  /// `quaternion_xyzw`; what is absent is zero or the identity.
  RigidTransform pose();

  /// Throws Error when the table holds a key that was never asked for. Tables read from it have a
  /// finish() of their own.
  void finish() const;

  /// "file.toml, key 'camera.fx_px'": how complaints name a key of this table.
  std::string where(const std::string& key) const;

  /// Folder of the file, from which relative paths in it count.
  std::filesystem::path folder() const;

 private:
  struct Impl;
  explicit TomlTable(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace facula
