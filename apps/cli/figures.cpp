// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/figures.hpp>
#include <facula/apps/cli/number_text.hpp>

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

namespace facula {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 16> kUnits{{{"mm", "mm"},
                                                                      {"m", "m"},
                                                                      {"deg", "deg"},
                                                                      {"rad", "rad"},
                                                                      {"px", "px"},
                                                                      {"dn", "DN"},
                                                                      {"m2", "m^2"},
                                                                      {"mm2", "mm^2"},
                                                                      {"m3", "m^3"},
                                                                      {"l", "l"},
                                                                      {"percent", "%"},
                                                                      {"s", "s"},
                                                                      {"mb", "MB"},
                                                                      {"mib", "MiB"},
                                                                      {"ppm", "ppm"},
                                                                      {"fps", "1/s"}}};

bool is_numeric(const FigureValue& value) {
  return std::holds_alternative<double>(value) || std::holds_alternative<long long>(value);
}

std::string padded(const std::string& text, std::size_t width, bool right) {
  const std::string blanks(width > text.size() ? width - text.size() : 0, ' ');
  return right ? blanks + text : text + blanks;
}

void write_figures(std::ostream& out, const std::vector<Figure>& figures) {
  std::size_t label_width = 0;
  std::size_t value_width = 0;
  for (const Figure& figure : figures) {
    label_width = std::max(label_width, figure.label.size());
    if (!is_numeric(figure.value)) continue;
    value_width = std::max(value_width, printed(figure.value, figure.decimals).size());
  }
  for (const Figure& figure : figures) {
    const std::string value = printed(figure.value, figure.decimals);
    const bool numeric = is_numeric(figure.value);
    const std::string unit = unit_of_key(figure.key);
    out << "  " << padded(figure.label, label_width, false) << "  "
        << (numeric ? padded(value, value_width, true) : value) << (unit.empty() ? "" : " ") << unit
        << '\n';
  }
}

void write_table(std::ostream& out, const FigureTable& table) {
  if (!table.title.empty()) out << table.title << '\n';
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    widths.push_back(heading(table.columns[c]).size());
    for (const auto& row : table.rows) {
      widths[c] = std::max(widths[c], printed(row[c], table.columns[c].decimals).size());
    }
  }
  const auto write_row = [&](const auto& cell, const auto& right) {
    std::string line;
    for (std::size_t c = 0; c < widths.size(); ++c) {
      line += "  " + padded(cell(c), widths[c], right(c));
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << '\n';
  };
  const auto numeric = [&](std::size_t c) {
    return !table.rows.empty() && !std::holds_alternative<std::string>(table.rows.front()[c]);
  };
  write_row([&](std::size_t c) { return heading(table.columns[c]); }, numeric);
  for (const auto& row : table.rows) {
    write_row([&](std::size_t c) { return printed(row[c], table.columns[c].decimals); }, numeric);
  }
}

}  // namespace

std::string printed(const FigureValue& value, int decimals) {
  struct Printer {
    int decimals;
    std::string operator()(double x) const { return fixed_text(x, decimals); }
    std::string operator()(long long x) const { return std::to_string(x); }
    std::string operator()(bool x) const { return x ? "yes" : "no"; }
    std::string operator()(const std::string& x) const { return x; }
    std::string operator()(const std::vector<double>& x) const {
      std::string all;
      for (const double one : x) {
        if (!all.empty()) all += ' ';
        all += fixed_text(one, decimals);
      }
      return all;
    }
  };
  return std::visit(Printer{decimals}, value);
}

std::string heading(const FigureTable::Column& column) {
  const std::string unit = unit_of_key(column.key);
  return unit.empty() ? column.label : column.label + " [" + unit + "]";
}

std::string unit_of_key(const std::string& key) {
  const std::string suffix = key.substr(key.rfind('_') + 1);
  if (suffix.size() == key.size()) return {};
  for (const auto& [name, unit] : kUnits) {
    if (suffix == name) return unit;
  }
  return {};
}

void Figures::number(const std::string& key, const std::string& label, double value, int decimals) {
  figures_.push_back({key, label, value, decimals});
}

void Figures::count(const std::string& key, const std::string& label, std::size_t value) {
  figures_.push_back({key, label, static_cast<long long>(value)});
}

void Figures::text(const std::string& key, const std::string& label, const std::string& value) {
  figures_.push_back({key, label, value});
}

void Figures::flag(const std::string& key, const std::string& label, bool value) {
  figures_.push_back({key, label, value});
}

void Figures::numbers(const std::string& key,
                      const std::string& label,
                      const std::vector<double>& value,
                      int decimals) {
  figures_.push_back({key, label, value, decimals});
}

void Figures::table(FigureTable table) {
  tables_.push_back(std::move(table));
}

Figures& Figures::part(const std::string& key, const std::string& title) {
  parts_.push_back({key, title, std::make_unique<Figures>()});
  return *parts_.back().figures;
}

void Figures::note(const std::string& sentence) {
  notes_.push_back(sentence);
}

std::vector<std::pair<std::string, std::string>> Figures::lines() const {
  std::vector<std::pair<std::string, std::string>> all;
  for (const Figure& figure : figures_) {
    const std::string unit = unit_of_key(figure.key);
    std::string value = printed(figure.value, figure.decimals);
    if (!unit.empty()) value.append(" ").append(unit);
    all.emplace_back(figure.label, value);
  }
  return all;
}

std::string Figures::text() const {
  std::ostringstream out;
  write_figures(out, figures_);
  for (const FigureTable& table : tables_) write_table(out, table);
  for (const Part& part : parts_) out << part.title << '\n' << part.figures->text();
  for (const std::string& sentence : notes_) out << sentence << '\n';
  return out.str();
}

}  // namespace facula
