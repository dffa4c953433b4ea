// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/ply_header.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>

#include <cmath>

namespace facula {
namespace {

/// What follows the header, as far as it is not read yet.
struct Body {
  const std::string& file;
  PlyEncoding encoding;
  std::string_view rest;
};

[[noreturn]] void fail_torn(const Body& body, const PlyElement& element) {
  fail("'",
       body.file,
       "' ends before the ",
       element.rows,
       " rows of its element '",
       element.name,
       "' are complete; the file is torn");
}

double take_value(Body& body, NumberType type, const PlyElement& element) {
  if (body.encoding == PlyEncoding::kAscii) {
    const std::string_view word = take_word(body.rest);
    if (word.empty()) fail_torn(body, element);
    const auto value = parse_number<double>(word);
    require(value.has_value(),
            "'",
            body.file,
            "' has '",
            word.substr(0, 40),
            "' where element '",
            element.name,
            "' needs a number");
    return *value;
  }
  const std::size_t size = size_of(type);
  if (body.rest.size() < size) fail_torn(body, element);
  const double value =
      decode_number(body.rest.data(), type, body.encoding == PlyEncoding::kBigEndian);
  body.rest.remove_prefix(size);
  return value;
}

void take_list(Body& body, PlyProperty& property, const PlyElement& element) {
  const double count = take_value(body, *property.count_type, element);
  require(count >= 0 && count == std::floor(count),
          "'",
          body.file,
          "' has a list '",
          property.name,
          "' of ",
          count,
          " entries; expected a whole number of 0 or more");
  if (count > static_cast<double>(body.rest.size())) fail_torn(body, element);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    property.values.push_back(take_value(body, property.type, element));
  }
  property.ends.push_back(property.values.size());
}

/// The fewest bytes a row can take, so that absurd counts are refused before memory is taken.
std::size_t smallest_row(const PlyElement& element, PlyEncoding encoding) {
  if (encoding == PlyEncoding::kAscii) return 2 * element.properties.size();
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    bytes += size_of(property.count_type.value_or(property.type));
  }
  return bytes;
}

void take_rows(Body& body, PlyElement& element) {
  const std::size_t smallest = smallest_row(element, body.encoding);
  if (smallest == 0) return;
  // The last row of a text may lack its line end, hence the byte more.
  if (element.rows > (body.rest.size() + 1) / smallest) {
    fail_torn(body, element);
  }
  for (PlyProperty& property : element.properties) {
    (property.count_type ? property.ends.reserve(element.rows)
                         : property.values.reserve(element.rows));
  }
  for (std::size_t row = 0; row < element.rows; ++row) {
    for (PlyProperty& property : element.properties) {
      if (property.count_type) {
        take_list(body, property, element);
      } else {
        property.values.push_back(take_value(body, property.type, element));
      }
    }
  }
}

void put_row(std::string& bytes, const PlyElement& element, std::size_t row) {
  for (const PlyProperty& property : element.properties) {
    std::size_t begin = row;
    std::size_t end = row + 1;
    if (property.count_type) {
      begin = row == 0 ? 0 : property.ends[row - 1];
      end = property.ends[row];
      encode_number(bytes, *property.count_type, static_cast<double>(end - begin));
    }
    for (std::size_t i = begin; i < end; ++i) {
      encode_number(bytes, property.type, property.values[i]);
    }
  }
}

}  // namespace

const PlyProperty* PlyElement::find(const std::string& property) const {
  for (const PlyProperty& candidate : properties) {
    if (candidate.name == property) return &candidate;
  }
  return nullptr;
}

std::vector<PlyElement> read_ply(const std::filesystem::path& path,
                                 std::vector<std::string>* infos) {
  const std::string file = path.string();
  const std::string bytes = read_whole_file(path);
  std::string_view rest = bytes;
  PlyHeader header = take_ply_header(rest, file);
  Body body{file, header.encoding, rest};
  for (PlyElement& element : header.elements) take_rows(body, element);
  require(take_word(body.rest).empty(),
          "'",
          file,
          "' holds more values than its PLY header declares; correct the counts in the header");
  if (infos != nullptr) *infos = std::move(header.infos);
  return std::move(header.elements);
}

const PlyElement& ply_element(const std::vector<PlyElement>& elements,
                              const std::string& name,
                              const std::filesystem::path& path) {
  for (const PlyElement& element : elements) {
    if (element.name == name) return element;
  }
  fail("the PLY file '", path.string(), "' has no element '", name, "'; choose another file");
}

void write_ply(const std::filesystem::path& path, const std::vector<PlyElement>& elements) {
  AtomicFile file(path);
  file.stream() << ply_header_text(elements);
  std::string bytes;
  for (const PlyElement& element : elements) {
    for (std::size_t row = 0; row < element.rows; ++row) {
      bytes.clear();
      put_row(bytes, element, row);
      file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
  }
  file.commit();
}

}  // namespace facula
