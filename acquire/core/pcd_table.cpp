// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/atomic_file.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/lzf.hpp>
#include <facula/acquire/core/pcd_header.hpp>
#include <facula/acquire/core/text_numbers.hpp>
#include <facula/acquire/core/whole_file.hpp>

namespace facula {
namespace {

bool is_packed_color(const PcdField& field) {
  return (field.name == "rgb" || field.name == "rgba") && size_of(field.type) == 4;
}

/// A packed colour is often declared as a float whose bits are meant.
NumberType stored_type(const PcdField& field) {
  return is_packed_color(field) ? NumberType::kUint32 : field.type;
}

std::size_t bytes_per_point(const PcdTable& table) {
  std::size_t bytes = 0;
  for (const PcdField& field : table.fields) bytes += size_of(field.type) * field.count;
  return bytes;
}

std::size_t values_per_point(const PcdTable& table) {
  std::size_t values = 0;
  for (const PcdField& field : table.fields) values += field.count;
  return values;
}

[[noreturn]] void fail_torn(const PcdHeader& header, const std::string& file) {
  fail("'",
       file,
       "' does not hold the data of the ",
       header.points,
       " points that its PCD header declares; the file is torn");
}

void reserve_values(PcdHeader& header) {
  for (PcdField& field : header.table.fields) field.values.reserve(header.points * field.count);
}

double text_value(std::string_view word, const PcdField& field, const std::string& file) {
  const auto value = parse_number<double>(word);
  require(value.has_value(),
          "'",
          file,
          "' has '",
          word.substr(0, 40),
          "' where the field ",
          field.name,
          " needs a number");
  if (!is_packed_color(field) || field.type != NumberType::kFloat32) return *value;
  std::string bits;
  encode_number(bits, NumberType::kFloat32, *value);
  return decode_number(bits.data(), NumberType::kUint32, false);
}

void take_text(std::string_view data, PcdHeader& header, const std::string& file) {
  const std::size_t per_point = values_per_point(header.table);
  if (per_point == 0 || header.points > (data.size() + 1) / (2 * per_point)) {
    fail_torn(header, file);
  }
  reserve_values(header);
  for (std::size_t i = 0; i < header.points; ++i) {
    for (PcdField& field : header.table.fields) {
      for (std::size_t k = 0; k < field.count; ++k) {
        const std::string_view word = take_word(data);
        if (word.empty()) fail_torn(header, file);
        field.values.push_back(text_value(word, field, file));
      }
    }
  }
  require(take_word(data).empty(),
          "'",
          file,
          "' holds more values than its PCD header declares; correct WIDTH, HEIGHT and POINTS");
}

void take_binary(std::string_view data, PcdHeader& header, const std::string& file) {
  const std::size_t stride = bytes_per_point(header.table);
  if (stride == 0 || header.points > data.size() / stride) fail_torn(header, file);
  require(data.size() == header.points * stride,
          "'",
          file,
          "' holds ",
          data.size() - header.points * stride,
          " bytes more than its PCD header declares; correct WIDTH, HEIGHT and POINTS");
  reserve_values(header);
  const char* bytes = data.data();
  for (std::size_t i = 0; i < header.points; ++i) {
    for (PcdField& field : header.table.fields) {
      for (std::size_t k = 0; k < field.count; ++k, bytes += size_of(field.type)) {
        field.values.push_back(decode_number(bytes, stored_type(field), false));
      }
    }
  }
}

/// Two sizes, then one LZF block in which each field's values lie together.
void take_compressed(std::string_view data, PcdHeader& header, const std::string& file) {
  if (data.size() < 8) fail_torn(header, file);
  const auto packed =
      static_cast<std::size_t>(decode_number(data.data(), NumberType::kUint32, false));
  const auto size =
      static_cast<std::size_t>(decode_number(data.data() + 4, NumberType::kUint32, false));
  data.remove_prefix(8);
  const std::size_t stride = bytes_per_point(header.table);
  if (stride == 0 || packed > data.size() || size % stride != 0 || size / stride != header.points) {
    fail_torn(header, file);
  }
  const auto unpacked = unpack_lzf(data.substr(0, packed), size);
  require(unpacked.has_value(),
          "the compressed data of '",
          file,
          "' cannot be unpacked; the file is torn");
  reserve_values(header);
  const char* bytes = unpacked->data();
  for (PcdField& field : header.table.fields) {
    for (std::size_t i = 0; i < header.points * field.count; ++i, bytes += size_of(field.type)) {
      field.values.push_back(decode_number(bytes, stored_type(field), false));
    }
  }
}

}  // namespace

const PcdField* PcdTable::find(const std::string& field) const {
  for (const PcdField& candidate : fields) {
    if (candidate.name == field && candidate.count == 1) return &candidate;
  }
  return nullptr;
}

const PcdField& PcdTable::field(const std::string& name, const std::filesystem::path& path) const {
  const PcdField* found = find(name);
  require(found != nullptr,
          "the PCD file '",
          path.string(),
          "' has no field ",
          name,
          "; expected at least x y z");
  return *found;
}

PcdTable read_pcd(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::string bytes = read_whole_file(path);
  std::string_view rest = bytes;
  PcdHeader header = take_pcd_header(rest, file);
  if (header.encoding == "ascii") {
    take_text(rest, header, file);
  } else if (header.encoding == "binary") {
    take_binary(rest, header, file);
  } else if (header.encoding == "binary_compressed") {
    take_compressed(rest, header, file);
  } else {
    fail("the PCD header of '",
         file,
         "' names the encoding '",
         header.encoding.substr(0, 40),
         "'; expected ascii, binary or binary_compressed");
  }
  return std::move(header.table);
}

void write_pcd(const std::filesystem::path& path, const PcdTable& table) {
  AtomicFile file(path);
  file.stream() << pcd_header_text(table);
  std::string bytes;
  for (std::size_t i = 0; i < table.width * table.height; ++i) {
    bytes.clear();
    for (const PcdField& field : table.fields) {
      for (std::size_t k = 0; k < field.count; ++k) {
        encode_number(bytes, field.type, field.values[i * field.count + k]);
      }
    }
    file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  file.commit();
}

}  // namespace facula
