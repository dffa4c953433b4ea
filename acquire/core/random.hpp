// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

namespace facula {

/// Seeded random numbers (xoshiro256++ by Blackman and Vigna, 2019, seeded by splitmix64), the same
/// on every machine. Streams with different `stream` numbers are independent of each other.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint64_t bits();

  /// Uniform in [0, 1).
  double uniform();

  /// Uniform in {0, ..., count - 1}; count at least 1.
  std::uint64_t below(std::uint64_t count);

  /// Normal with mean 0 and standard deviation 1 (Marsaglia's polar method).
  double normal();

 private:
  std::uint64_t state_[4];
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace facula
