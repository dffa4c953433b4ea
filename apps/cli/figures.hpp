// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace facula {

/// A value a command reports.
using FigureValue = std::variant<double, long long, bool, std::string, std::vector<double>>;

/// One figure. The unit stands once, at the end of the key: "rms_mm" is printed as "rms ... mm".
struct Figure {
  std::string key;    ///< name in JSON, unit included
  std::string label;  ///< name for people
  FigureValue value;
  int decimals = 0;  ///< printed; JSON keeps all digits
};

/// A table: rows of the same figures.
struct FigureTable {
  struct Column {
    std::string key;    ///< name in JSON, unit included
    std::string label;  ///< heading
    int decimals = 0;
  };
  std::string key;
  std::string title;
  std::vector<Column> columns;
  std::vector<std::vector<FigureValue>> rows;  ///< one value per column
};

/// Everything a command has to say. People and programs get the same figures: text() and json()
/// are two views of this one list.
class Figures {
 public:
  void number(const std::string& key, const std::string& label, double value, int decimals);
  void count(const std::string& key, const std::string& label, std::size_t value);
  void text(const std::string& key, const std::string& label, const std::string& value);
  void flag(const std::string& key, const std::string& label, bool value);
  void numbers(const std::string& key,
               const std::string& label,
               const std::vector<double>& value,
               int decimals);
  void table(FigureTable table);

  /// A part with its own heading, an object in JSON. Stays valid as long as these figures.
  Figures& part(const std::string& key, const std::string& title);

  /// A sentence for people, below the figures (JSON: "note_1" and so on).
  void note(const std::string& sentence);

  std::string text() const;
  std::string json() const;

  /// A part and its heading.
  struct Part {
    std::string key;
    std::string title;
    std::unique_ptr<Figures> figures;
  };
  const std::vector<Part>& parts() const { return parts_; }
  const std::vector<FigureTable>& tables() const { return tables_; }

  /// Label and value with unit of the figures that stand in no table and no part.
  std::vector<std::pair<std::string, std::string>> lines() const;

 private:
  friend struct FiguresJson;
  std::vector<Figure> figures_;
  std::vector<FigureTable> tables_;
  std::vector<Part> parts_;
  std::vector<std::string> notes_;
};

/// A heading with its unit, "rms [mm]", and a value as text() prints it.
std::string heading(const FigureTable::Column& column);
std::string printed(const FigureValue& value, int decimals);

/// The unit at the end of a key, as people write it: "rms_mm" gives "mm"; empty when none.
std::string unit_of_key(const std::string& key);

}  // namespace facula
