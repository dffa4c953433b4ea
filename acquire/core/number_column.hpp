// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace facula {

/// How a number lies in a file.
enum class NumberType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

/// A named column of a point file. Doubles hold every type exactly but 64-bit integers above 2^53.
struct NumberColumn {
  std::string name;
  NumberType type = NumberType::kFloat32;  ///< in the file
  std::vector<double> values;
};

/// Bytes of one number in a file.
std::size_t size_of(NumberType type);

/// Reads the number whose first byte `bytes` points to; size_of(type) bytes must be there.
double decode_number(const char* bytes, NumberType type, bool big_endian);

/// Appends a number in little-endian order. The value must fit the type.
void encode_number(std::string& bytes, NumberType type, double value);

}  // namespace facula
