// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/triangulate/binned_median.hpp>

#include <algorithm>
#include <bit>

namespace facula {
namespace {

// The bits of a positive float, read as a whole number, grow with it; the upper ones are exponent
// and 10 bits of the fraction, 1024 bins for every doubling.
constexpr int kDroppedBits = 13;

constexpr std::uint32_t bin_of(float value) {
  return std::bit_cast<std::uint32_t>(value) >> kDroppedBits;
}

constexpr float kLeast = 1e-9F;
constexpr float kMost = 1e9F;

}  // namespace

BinnedMedian::BinnedMedian() : counts_(bin_of(kMost) - bin_of(kLeast) + 1, 0) {}

void BinnedMedian::add(float value) {
  const float clamped = value > kLeast ? std::min(value, kMost) : kLeast;
  ++counts_[bin_of(clamped) - bin_of(kLeast)];
  ++total_;
}

double BinnedMedian::value() const {
  std::size_t below = 0;
  for (std::uint32_t bin = 0; bin < counts_.size(); ++bin) {
    below += counts_[bin];
    if (below <= total_ / 2) continue;
    const std::uint32_t bits =
        ((bin + bin_of(kLeast)) << kDroppedBits) + (1U << (kDroppedBits - 1));
    return static_cast<double>(std::bit_cast<float>(bits));
  }
  return 0;
}

}  // namespace facula
