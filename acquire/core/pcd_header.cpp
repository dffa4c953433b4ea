// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/pcd_header.hpp>
#include <facula/acquire/core/text_numbers.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

namespace facula {
namespace {

using Words = std::vector<std::string>;

constexpr std::size_t kMostValues = 65536;  ///< of one field in one point

/// The header's lines by their first word.
struct Lines {
  const std::string& file;
  std::map<std::string, Words> words;

  const Words& operator[](const std::string& keyword) const {
    const auto found = words.find(keyword);
    require(found != words.end() && !found->second.empty(),
            "the PCD header of '",
            file,
            "' has no line ",
            keyword,
            "; it is not a PCD file, or torn");
    return found->second;
  }
};

std::size_t whole_number(const std::string& word, const char* keyword, const std::string& file) {
  const auto value = parse_number<std::size_t>(word);
  require(value.has_value(),
          "the PCD header of '",
          file,
          "' has '",
          word.substr(0, 40),
          "' in its line ",
          keyword,
          "; expected a whole number");
  return *value;
}

NumberType type_of(const std::string& letter, const std::string& size, const std::string& file) {
  static const std::map<std::string, NumberType> known{{"I1", NumberType::kInt8},
                                                       {"I2", NumberType::kInt16},
                                                       {"I4", NumberType::kInt32},
                                                       {"I8", NumberType::kInt64},
                                                       {"U1", NumberType::kUint8},
                                                       {"U2", NumberType::kUint16},
                                                       {"U4", NumberType::kUint32},
                                                       {"U8", NumberType::kUint64},
                                                       {"F4", NumberType::kFloat32},
                                                       {"F8", NumberType::kFloat64}};
  const auto found = known.find(letter + size);
  require(found != known.end(),
          "the PCD header of '",
          file,
          "' declares a field of type ",
          letter.substr(0, 40),
          " and size ",
          size.substr(0, 40),
          "; expected I or U with 1, 2, 4 or 8 bytes, or F with 4 or 8");
  return found->second;
}

std::vector<PcdField> fields_of(const Lines& lines) {
  const bool old_name = lines.words.count("FIELDS") == 0 && lines.words.count("COLUMNS") != 0;
  const Words& names = lines[old_name ? "COLUMNS" : "FIELDS"];
  const Words& sizes = lines["SIZE"];
  const Words& types = lines["TYPE"];
  const Words counts = lines.words.count("COUNT") != 0 ? lines["COUNT"] : Words(names.size(), "1");
  require(
      sizes.size() == names.size() && types.size() == names.size() && counts.size() == names.size(),
      "the PCD header of '",
      lines.file,
      "' names ",
      names.size(),
      " fields but gives ",
      sizes.size(),
      " sizes, ",
      types.size(),
      " types and ",
      counts.size(),
      " counts; they must be as many");
  std::vector<PcdField> fields(names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    fields[i].name = names[i];
    fields[i].type = type_of(types[i], sizes[i], lines.file);
    fields[i].count = whole_number(counts[i], "COUNT", lines.file);
    require(fields[i].count >= 1 && fields[i].count <= kMostValues,
            "the PCD header of '",
            lines.file,
            "' gives the field ",
            names[i],
            " a COUNT of ",
            fields[i].count,
            "; expected 1 to ",
            kMostValues);
  }
  return fields;
}

std::array<double, 7> viewpoint_of(const Lines& lines) {
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};
  if (lines.words.count("VIEWPOINT") == 0) return viewpoint;
  const Words& words = lines["VIEWPOINT"];
  require(words.size() == 7,
          "the PCD header of '",
          lines.file,
          "' has ",
          words.size(),
          " numbers in VIEWPOINT; expected 7 (tx ty tz qw qx qy qz)");
  for (std::size_t i = 0; i < 7; ++i) {
    const auto value = parse_number<double>(words[i]);
    require(value.has_value(),
            "the PCD header of '",
            lines.file,
            "' has '",
            words[i].substr(0, 40),
            "' in VIEWPOINT; expected a number");
    viewpoint[i] = *value;
  }
  return viewpoint;
}

void set_size(PcdHeader& header, const Lines& lines) {
  PcdTable& table = header.table;
  table.width = whole_number(lines["WIDTH"][0], "WIDTH", lines.file);
  if (lines.words.count("HEIGHT") != 0) {
    table.height = whole_number(lines["HEIGHT"][0], "HEIGHT", lines.file);
  }
  const std::size_t most = std::numeric_limits<std::size_t>::max();
  const bool fits = table.height == 0 || table.width <= most / table.height;
  header.points = fits ? table.width * table.height : 0;
  const bool agrees = lines.words.count("POINTS") == 0 ||
                      whole_number(lines["POINTS"][0], "POINTS", lines.file) == header.points;
  require(fits && agrees,
          "the PCD header of '",
          lines.file,
          "' contradicts itself: WIDTH ",
          table.width,
          " times HEIGHT ",
          table.height,
          " is not the number of POINTS; write the file again");
}

Words words_of(std::string_view line) {
  Words words;
  for (auto word = take_word(line); !word.empty(); word = take_word(line)) {
    words.emplace_back(word);
  }
  return words;
}

std::string without_blanks_around(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, text.find_last_not_of(" \t") - begin + 1));
}

}  // namespace

PcdHeader take_pcd_header(std::string_view& text, const std::string& file) {
  PcdHeader header;
  Lines lines{file, {}};
  while (lines.words.count("DATA") == 0) {
    require(
        !text.empty(), "'", file, "' is not a PCD file: it has no line DATA; choose another file");
    std::string_view line = take_line(text);
    if (line.starts_with('#')) {
      header.table.comments.push_back(without_blanks_around(line.substr(1)));
      continue;
    }
    const std::string keyword(take_word(line));
    if (!keyword.empty()) lines.words[keyword] = words_of(line);
  }
  header.encoding = lines["DATA"][0];
  header.table.fields = fields_of(lines);
  header.table.viewpoint = viewpoint_of(lines);
  set_size(header, lines);
  return header;
}

std::string pcd_header_text(const PcdTable& table) {
  static constexpr std::string_view kLetters = "IUIUIUIUFF";  // in the order of NumberType
  std::string text = "# .PCD v0.7 - Point Cloud Data file format\n";
  for (const std::string& comment : table.comments) text += "# " + comment + "\n";
  std::string names = "FIELDS";
  std::string sizes = "SIZE";
  std::string types = "TYPE";
  std::string counts = "COUNT";
  for (const PcdField& field : table.fields) {
    names += " " + field.name;
    sizes += " " + number_text(size_of(field.type));
    types += {' ', kLetters[static_cast<std::size_t>(field.type)]};
    counts += " " + number_text(field.count);
  }
  text += "VERSION 0.7\n" + names + "\n" + sizes + "\n" + types + "\n" + counts + "\n";
  text += "WIDTH " + number_text(table.width) + "\nHEIGHT " + number_text(table.height);
  text += "\nVIEWPOINT";
  for (const double value : table.viewpoint) text += " " + number_text(value);
  return text + "\nPOINTS " + number_text(table.width * table.height) + "\nDATA binary\n";
}

}  // namespace facula
