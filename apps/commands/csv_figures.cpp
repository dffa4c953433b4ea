// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/apps/commands/csv_figures.hpp>

#include <cmath>

namespace facula {
namespace {

/// Text between quotes where it holds a comma, a quote or a line end (RFC 4180).
std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char letter : text) result += letter == '"' ? "\"\"" : std::string(1, letter);
  return result + '"';
}

struct CellText {
  std::string operator()(double value) const {
    return std::isfinite(value) ? number_text(value) : std::string();
  }
  std::string operator()(long long value) const { return std::to_string(value); }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(const std::string& value) const { return quoted(value); }
  std::string operator()(const std::vector<double>& values) const {
    std::string result;
    for (const double value : values) result += (result.empty() ? "" : " ") + number_text(value);
    return result;
  }
};

}  // namespace

void write_table_csv(const std::filesystem::path& path, const FigureTable& table) {
  AtomicFile file(path);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    file.stream() << (c > 0 ? "," : "") << quoted(table.columns[c].key);
  }
  file.stream() << '\n';
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      file.stream() << (c > 0 ? "," : "") << std::visit(CellText{}, row[c]);
    }
    file.stream() << '\n';
  }
  file.commit();
}

}  // namespace facula
