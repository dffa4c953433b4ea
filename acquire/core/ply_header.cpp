// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/ply_header.hpp>
#include <facula/acquire/core/text_numbers.hpp>

#include <array>

namespace facula {
namespace {

struct TypeName {
  std::string_view name;
  NumberType type;
};

/// The original names first: they are the ones written.
constexpr std::array<TypeName, 16> kTypeNames{{{"char", NumberType::kInt8},
                                               {"uchar", NumberType::kUint8},
                                               {"short", NumberType::kInt16},
                                               {"ushort", NumberType::kUint16},
                                               {"int", NumberType::kInt32},
                                               {"uint", NumberType::kUint32},
                                               {"float", NumberType::kFloat32},
                                               {"double", NumberType::kFloat64},
                                               {"int8", NumberType::kInt8},
                                               {"uint8", NumberType::kUint8},
                                               {"int16", NumberType::kInt16},
                                               {"uint16", NumberType::kUint16},
                                               {"int32", NumberType::kInt32},
                                               {"uint32", NumberType::kUint32},
                                               {"float32", NumberType::kFloat32},
                                               {"float64", NumberType::kFloat64}}};

NumberType type_named(std::string_view name, const std::string& file) {
  for (const TypeName& known : kTypeNames) {
    if (known.name == name) return known.type;
  }
  fail("the PLY header of '",
       file,
       "' declares a property of type '",
       name,
       "'; expected char, uchar, short, ushort, int, uint, float or double");
}

std::string_view name_of(NumberType type) {
  for (const TypeName& known : kTypeNames) {
    if (known.type == type) return known.name;
  }
  fail("PLY files hold no 64-bit integers; choose another type for the column");
}

PlyEncoding encoding_named(std::string_view name, const std::string& file) {
  if (name == "ascii") return PlyEncoding::kAscii;
  if (name == "binary_little_endian") return PlyEncoding::kLittleEndian;
  if (name == "binary_big_endian") return PlyEncoding::kBigEndian;
  fail("the PLY header of '",
       file,
       "' names the format '",
       name,
       "'; expected ascii, binary_little_endian or binary_big_endian");
}

PlyElement element_of(std::string_view line, const std::string& file) {
  PlyElement element;
  element.name = take_word(line);
  const std::string_view count = take_word(line);
  const auto rows = parse_number<std::size_t>(count);
  require(rows.has_value(),
          "the PLY header of '",
          file,
          "' gives element '",
          element.name,
          "' the count '",
          count,
          "'; expected a whole number");
  element.rows = *rows;
  return element;
}

PlyProperty property_of(std::string_view line, const std::string& file) {
  PlyProperty property;
  std::string_view type = take_word(line);
  if (type == "list") {
    property.count_type = type_named(take_word(line), file);
    type = take_word(line);
  }
  property.type = type_named(type, file);
  property.name = take_word(line);
  require(!property.name.empty(),
          "the PLY header of '",
          file,
          "' declares a property without a name; write the file again");
  return property;
}

}  // namespace

PlyHeader take_ply_header(std::string_view& text, const std::string& file) {
  require(
      take_line(text) == "ply", "'", file, "' is not a PLY file: expected 'ply' on its first line");
  PlyHeader header;
  bool has_format = false;
  while (true) {
    require(!text.empty(), "the PLY header of '", file, "' has no end_header; the file is torn");
    std::string_view line = take_line(text);
    const std::string_view keyword = take_word(line);
    if (keyword == "end_header") break;
    if (keyword == "format") {
      header.encoding = encoding_named(take_word(line), file);
      has_format = true;
    } else if (keyword == "element") {
      header.elements.push_back(element_of(line, file));
    } else if (keyword == "property") {
      require(!header.elements.empty(),
              "the PLY header of '",
              file,
              "' declares a property before any element; write the file again");
      header.elements.back().properties.push_back(property_of(line, file));
    } else if (keyword == "obj_info") {
      header.infos.emplace_back(line);
    } else {
      require(keyword.empty() || keyword == "comment",
              "the PLY header of '",
              file,
              "' has a line that starts with '",
              keyword.substr(0, 40),
              "'; expected format, element, property, comment or end_header");
    }
  }
  require(has_format, "the PLY header of '", file, "' names no format; add 'format ascii 1.0'");
  return header;
}

std::string ply_header_text(const std::vector<PlyElement>& elements) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  for (const PlyElement& element : elements) {
    text += "element " + element.name + " " + number_text(element.rows) + "\n";
    for (const PlyProperty& property : element.properties) {
      text += "property ";
      if (property.count_type) {
        text.append("list ").append(name_of(*property.count_type)).append(" ");
      }
      text.append(name_of(property.type)).append(" ").append(property.name).append("\n");
    }
  }
  return text + "end_header\n";
}

}  // namespace facula
