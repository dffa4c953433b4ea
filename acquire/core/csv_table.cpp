// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/csv_table.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace facula {
namespace {

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\"");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\"") - first + 1));
}

std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    cells.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

double unit_of(std::string_view name) {
  if (name.ends_with("_mm")) return 1e-3;
  if (name.ends_with("_deg")) return std::numbers::pi / 180;
  return 1;
}

std::string listed(const std::vector<std::string>& names, const char* between) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : between) + name;
  return text;
}

}  // namespace

CsvTable CsvTable::from_file(const std::filesystem::path& path) {
  const std::string text = read_whole_file(path);
  CsvTable table;
  table.path_ = path;
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // as spreadsheets write it
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    const std::string_view line = take_line(rest);
    const std::string content = trimmed(line);
    if (content.empty() || content.front() == '#') continue;
    std::vector<std::string> cells = cells_of(line);
    if (table.names_.empty()) {
      table.names_ = std::move(cells);
      continue;
    }
    require(cells.size() == table.names_.size(),
            path.string(),
            ", line ",
            line_number,
            ": expected ",
            table.names_.size(),
            " cells as in the header, got ",
            cells.size());
    table.rows_.push_back({line_number, std::move(cells)});
  }
  require(table.names_.size() != 1 || table.names_[0].find_first_of(";\t") == std::string::npos,
          path.string(),
          ": expected commas between the columns, got '",
          table.names_.empty() ? "" : table.names_[0],
          "'; save it with commas, and numbers with points");
  require(!table.rows_.empty(),
          path.string(),
          ": expected a header line and rows of numbers below it, got ",
          table.names_.empty() ? "an empty table" : "the header alone");
  return table;
}

bool CsvTable::has(std::string_view name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

std::size_t CsvTable::index_of(const std::vector<std::string>& names) const {
  const auto wanted =
      std::find_if(names.begin(), names.end(), [&](const std::string& n) { return has(n); });
  require(wanted != names.end(),
          path_.string(),
          ": expected a column called ",
          listed(names, " or "),
          ", got the columns ",
          listed(names_, ", "));
  return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), *wanted) -
                                  names_.begin());
}

std::vector<double> CsvTable::column(const std::vector<std::string>& names) const {
  const std::size_t index = index_of(names);
  const double unit = unit_of(names_[index]);
  std::vector<double> values;
  values.reserve(rows_.size());
  for (const Row& row : rows_) {
    const auto value = parse_number<double>(row.cells[index]);
    require(value.has_value() && std::isfinite(*value),
            path_.string(),
            ", line ",
            row.line,
            ": expected a finite number in column ",
            names_[index],
            ", got '",
            row.cells[index],
            "'");
    values.push_back(*value * unit);
  }
  return values;
}

std::vector<std::string> CsvTable::texts(const std::string& name) const {
  const std::size_t index = index_of({name});
  std::vector<std::string> values;
  values.reserve(rows_.size());
  for (const Row& row : rows_) values.push_back(row.cells[index]);
  return values;
}

}  // namespace facula
