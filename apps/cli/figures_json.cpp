// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/cli/figures.hpp>

#include <cmath>

#include <nlohmann/json.hpp>

namespace facula {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no NaN: an unknown number is null.
Json json_number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json json_value(const FigureValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return json_number(*number);
  if (const auto* whole = std::get_if<long long>(&value)) return *whole;
  if (const auto* yes = std::get_if<bool>(&value)) return *yes;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  Json list = Json::array();
  for (const double number : std::get<std::vector<double>>(value)) {
    list.push_back(json_number(number));
  }
  return list;
}

Json json_table(const FigureTable& table) {
  Json rows = Json::array();
  for (const auto& row : table.rows) {
    Json object = Json::object();
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      object[table.columns[c].key] = json_value(row[c]);
    }
    rows.push_back(object);
  }
  return rows;
}

}  // namespace

struct FiguresJson {
  static Json of(const Figures& figures) {
    Json object = Json::object();
    for (const Figure& figure : figures.figures_) object[figure.key] = json_value(figure.value);
    for (const FigureTable& table : figures.tables_) object[table.key] = json_table(table);
    for (const auto& part : figures.parts_) object[part.key] = of(*part.figures);
    int number = 0;
    for (const std::string& note : figures.notes_)
      object["note_" + std::to_string(++number)] = note;
    return object;
  }
};

std::string Figures::json() const {
  // Paths may hold any bytes; those that are not UTF-8 are replaced instead of refused.
  return FiguresJson::of(*this).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace facula
