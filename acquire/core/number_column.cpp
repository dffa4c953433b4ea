// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/number_column.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace facula {
namespace {

static_assert(std::endian::native == std::endian::little,
              "bytes are copied as they lie in memory on a little-endian machine");

template <typename Number>
double decode(const char* bytes, bool big_endian) {
  std::array<char, sizeof(Number)> buffer{};
  std::copy_n(bytes, sizeof(Number), buffer.begin());
  if (big_endian) std::reverse(buffer.begin(), buffer.end());
  return static_cast<double>(std::bit_cast<Number>(buffer));
}

template <typename Number>
void encode(std::string& bytes, double value) {
  const auto buffer = std::bit_cast<std::array<char, sizeof(Number)>>(static_cast<Number>(value));
  bytes.append(buffer.data(), buffer.size());
}

}  // namespace

std::size_t size_of(NumberType type) {
  constexpr std::array<std::size_t, 10> kSizes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

double decode_number(const char* bytes, NumberType type, bool big_endian) {
  switch (type) {
    case NumberType::kInt8:
      return decode<std::int8_t>(bytes, big_endian);
    case NumberType::kUint8:
      return decode<std::uint8_t>(bytes, big_endian);
    case NumberType::kInt16:
      return decode<std::int16_t>(bytes, big_endian);
    case NumberType::kUint16:
      return decode<std::uint16_t>(bytes, big_endian);
    case NumberType::kInt32:
      return decode<std::int32_t>(bytes, big_endian);
    case NumberType::kUint32:
      return decode<std::uint32_t>(bytes, big_endian);
    case NumberType::kInt64:
      return decode<std::int64_t>(bytes, big_endian);
    case NumberType::kUint64:
      return decode<std::uint64_t>(bytes, big_endian);
    case NumberType::kFloat32:
      return decode<float>(bytes, big_endian);
    case NumberType::kFloat64:
      return decode<double>(bytes, big_endian);
  }
  fail("a column has a number type that does not exist");
}

void encode_number(std::string& bytes, NumberType type, double value) {
  switch (type) {
    case NumberType::kInt8:
      return encode<std::int8_t>(bytes, value);
    case NumberType::kUint8:
      return encode<std::uint8_t>(bytes, value);
    case NumberType::kInt16:
      return encode<std::int16_t>(bytes, value);
    case NumberType::kUint16:
      return encode<std::uint16_t>(bytes, value);
    case NumberType::kInt32:
      return encode<std::int32_t>(bytes, value);
    case NumberType::kUint32:
      return encode<std::uint32_t>(bytes, value);
    case NumberType::kInt64:
      return encode<std::int64_t>(bytes, value);
    case NumberType::kUint64:
      return encode<std::uint64_t>(bytes, value);
    case NumberType::kFloat32:
      return encode<float>(bytes, value);
    case NumberType::kFloat64:
      return encode<double>(bytes, value);
  }
}

}  // namespace facula
