// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/tests/bench/accuracy/table_file.hpp>

#include <charconv>
#include <fstream>
#include <sstream>

namespace facula {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace

std::vector<std::map<std::string, double>> read_table(const std::filesystem::path& path) {
  std::ifstream in(path);
  require(in.good(), "expected the table '", path.string(), "', but it cannot be read");
  std::vector<std::string> columns;
  std::vector<std::map<std::string, double>> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> cells = cells_of(line);
    if (columns.empty()) {
      columns = cells;
      continue;
    }
    std::map<std::string, double> row;
    for (std::size_t i = 0; i < cells.size() && i < columns.size(); ++i) {
      double value = 0;
      const char* end = cells[i].data() + cells[i].size();
      if (std::from_chars(cells[i].data(), end, value).ptr == end && !cells[i].empty()) {
        row[columns[i]] = value;
      }
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace facula
