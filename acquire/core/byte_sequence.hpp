// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace facula {

static_assert(std::endian::native == std::endian::little, "binary files are little-endian");

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

inline ByteView bytes_of_text(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Appends numbers as they lie in memory, lowest byte first.
template <typename Number>
void put(Bytes& bytes, Number value) {
  static_assert(std::is_arithmetic_v<Number>);
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof(value));
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}

inline void put_bytes(Bytes& bytes, const void* data, std::size_t size) {
  if (size == 0) return;
  const std::size_t at = bytes.size();
  bytes.resize(at + size);
  std::memcpy(bytes.data() + at, data, size);
}

/// Overwrites a number put before.
template <typename Number>
void put_at(Bytes& bytes, std::size_t at, Number value) {
  std::memcpy(bytes.data() + at, &value, sizeof(value));
}

/// Takes numbers from the front. Asking for more than there is gives zeros and is remembered.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) : rest_(bytes) {}

  template <typename Number>
  Number take() {
    Number value{};
    take_bytes(&value, sizeof(value));
    return value;
  }

  void take_bytes(void* data, std::size_t size) {
    const ByteView part = take_view(size);
    if (!part.empty()) std::memcpy(data, part.data(), size);
  }

  /// The next bytes where they lie; empty when there are fewer.
  ByteView take_view(std::size_t size) {
    if (size > rest_.size()) {
      failed_ = true;
      return {};
    }
    const ByteView part = rest_.first(size);
    rest_ = rest_.subspan(size);
    return part;
  }

  std::size_t left() const { return rest_.size(); }
  bool failed() const { return failed_; }

 private:
  ByteView rest_;
  bool failed_ = false;
};

}  // namespace facula
