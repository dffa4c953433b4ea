// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace facula {

/// A table of numbers with named columns, as spreadsheets write it: lines that begin with # are
/// comments, the first other line names the columns, cells are parted by commas. The unit stands at
/// the end of a column's name ("distance_mm").
class CsvTable {
 public:
  /// Throws Error when the file is missing, has no header or no rows, or a row has not as many
  /// cells as the header (with its line).
  static CsvTable from_file(const std::filesystem::path& path);

  std::size_t rows() const { return rows_.size(); }
  bool has(std::string_view name) const;

  /// The finite numbers of the first column found that is called one of `names`, brought to metres
  /// or radians where its name ends in _mm or _deg. Throws Error when there is none, or naming the
  /// line of a cell that is no finite number.
  std::vector<double> column(const std::vector<std::string>& names) const;

  /// A column as it stands. Throws Error when there is none of that name.
  std::vector<std::string> texts(const std::string& name) const;

 private:
  std::size_t index_of(const std::vector<std::string>& names) const;

  struct Row {
    std::size_t line = 0;
    std::vector<std::string> cells;
  };
  std::filesystem::path path_;
  std::vector<std::string> names_;
  std::vector<Row> rows_;
};

}  // namespace facula
