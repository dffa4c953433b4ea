// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/bench/accuracy/study.hpp>

#include <iomanip>
#include <locale>
#include <sstream>

namespace facula {
namespace {

std::string markdown_row(const std::vector<std::string>& cells) {
  std::string row = "|";
  for (const std::string& cell : cells) row += " " + cell + " |";
  return row + "\n";
}

std::string markdown_table(const StudyTable& table) {
  std::string text = table.caption + "\n\n" + markdown_row(table.columns);
  text += markdown_row(std::vector<std::string>(table.columns.size(), "---"));
  for (const auto& row : table.rows) text += markdown_row(row);
  return text;
}

}  // namespace

std::string markdown(const Study& study) {
  std::string text = "## " + study.title + "\n";
  for (const std::string& paragraph : study.paragraphs) text += "\n" + paragraph + "\n";
  for (const StudyTable& table : study.tables) text += "\n" + markdown_table(table);
  if (!study.verdicts.empty()) {
    text += "\n" + markdown_row({"asked", "measured", ""}) + markdown_row({"---", "---", "---"});
    for (const Verdict& v : study.verdicts) {
      text += markdown_row({v.claim, v.measured, v.reached ? "reached" : "**missed**"});
    }
  }
  return text;
}

std::string decimals(double value, int count) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out << std::fixed << std::setprecision(count) << value;
  return out.str();
}

}  // namespace facula
