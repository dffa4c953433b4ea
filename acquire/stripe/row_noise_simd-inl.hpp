// SPDX-License-Identifier: GPL-3.0-or-later
// estimate_noise() of row_noise.cpp for whole vectors. Included once per instruction set; see
// stripe_simd.cpp.
#if defined(FACULA_ROW_NOISE_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef FACULA_ROW_NOISE_SIMD
#undef FACULA_ROW_NOISE_SIMD
#else
#define FACULA_ROW_NOISE_SIMD
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE hn::Vec<hn::ScalableTag<std::int16_t>> load_wide(const std::uint8_t* from) {
  const hn::ScalableTag<std::int16_t> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  return hn::PromoteTo(d, hn::LoadU(bytes, from));
}

HWY_INLINE hn::Vec<hn::ScalableTag<std::int16_t>> load_wide(const std::int16_t* from) {
  return hn::LoadU(hn::ScalableTag<std::int16_t>(), from);
}

/// The first of the largest values of a row.
template <typename Value>
HWY_INLINE int brightest_column(const Value* row, int cols) {
  const hn::ScalableTag<std::int16_t> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  auto highest = load_wide(row);
  int c = lanes;
  for (; c + lanes <= cols; c += lanes) highest = hn::Max(highest, load_wide(row + c));
  highest = hn::Max(highest, load_wide(row + cols - lanes));
  const auto wanted = hn::MaxOfLanes(d, highest);
  for (c = 0;; c += lanes) {
    const int at = std::min(c, cols - lanes);
    const auto first = hn::FindFirstTrue(d, hn::Eq(load_wide(row + at), wanted));
    if (first >= 0) return at + static_cast<int>(first);
  }
}

/// Sizes of second differences as bytes, 255 where the stripe is and behind the end of the row.
template <typename Value>
HWY_INLINE void store_differences(const Value* row, int cols, std::uint8_t* differences) {
  const hn::ScalableTag<std::int16_t> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int c = 1; c + 1 < cols; c += lanes) {
    const int at = std::min(c, cols - 1 - lanes);  // the last ones overlap those before
    const auto middle = load_wide(row + at);
    const auto sides = hn::Add(load_wide(row + at - 1), load_wide(row + at + 1));
    const auto size = hn::Abs(hn::Sub(hn::Add(middle, middle), sides));
    hn::StoreU(hn::DemoteTo(bytes, size), bytes, differences + at - 1);
  }
  std::memset(differences + cols - 2, 255, HWY_MAX_BYTES);
}

HWY_INLINE int count_up_to(const std::uint8_t* values, int count, int most) {
  const hn::ScalableTag<std::uint8_t> d;
  const auto limit = hn::Set(d, static_cast<std::uint8_t>(most));
  std::size_t found = 0;
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const auto v = hn::LoadU(d, values + i);
    found += hn::CountTrue(d, hn::Eq(hn::Min(v, limit), v));
  }
  return static_cast<int>(found);
}

/// The least value that `kept` of all do not exceed, looked for from `guess` on.
HWY_INLINE int quantile(const std::uint8_t* values, int count, int kept, int guess) {
  int low = 0;
  int high = 255;
  int middle = std::clamp(guess, 0, 254);
  for (int step = 0; low < high; ++step) {
    if (count_up_to(values, count, middle) >= kept) {
      high = middle;
    } else {
      low = middle + 1;
    }
    // Beside the guess first: noise is about the same in all rows.
    middle = step < 2 ? std::clamp(high == middle ? middle - 1 : middle + 1, low, high)
                      : (low + high) / 2;
    if (middle == high && low < high) middle = (low + high) / 2;
  }
  return low;
}

/// Sum of the values below `limit`; how many they are is added to `below`.
HWY_INLINE int sum_below(const std::uint8_t* values, int count, int limit, int& below) {
  const hn::ScalableTag<std::uint8_t> d;
  const hn::Repartition<std::uint64_t, decltype(d)> d64;
  auto sum = hn::Zero(d64);
  if (limit == 0) return 0;
  const auto most = hn::Set(d, static_cast<std::uint8_t>(limit - 1));
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(d))) {
    const auto v = hn::LoadU(d, values + i);
    const auto is_below = hn::Eq(hn::Min(v, most), v);
    below += static_cast<int>(hn::CountTrue(d, is_below));
    sum = hn::Add(sum, hn::SumsOf8(hn::IfThenElseZero(is_below, v)));
  }
  return static_cast<int>(hn::GetLane(hn::SumOfLanes(d64, sum)));
}

/// estimate_noise() for `rows` rows of `cols` columns, 64 or more; row_of(r) is where row r begins.
template <typename RowOf>
HWY_NOINLINE float estimate_noise(int rows, int cols, const RowOf& row_of) {
  constexpr int kStripeReach = 10;
  std::vector<float> per_row;
  std::vector<std::uint8_t> differences(static_cast<std::size_t>(cols) + 2 * HWY_MAX_BYTES);
  std::uint8_t* sizes = differences.data();
  const int step = noise_row_step(rows, cols);
  const int count = cols - 2;
  int guess = 4;
  for (int r = step / 2; r < rows; r += step) {
    const auto* row = row_of(r);
    store_differences(row, cols, sizes);
    const int brightest = brightest_column(row, cols) - 1;
    const int first = std::max(0, brightest - kStripeReach);
    const int last = std::min(count, brightest + kStripeReach + 1);
    std::memset(sizes + first, 255, static_cast<std::size_t>(last - first));
    const int kept = (count - (last - first)) * 3 / 4;
    guess = quantile(sizes, count, kept, guess);
    int below = 0;
    const int sum = sum_below(sizes, count, guess, below);
    per_row.push_back(row_noise_from(sum + (kept - below) * guess, kept));
  }
  return frame_noise_from(per_row);
}

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#endif  // FACULA_ROW_NOISE_SIMD
