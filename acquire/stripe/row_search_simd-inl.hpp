// SPDX-License-Identifier: GPL-3.0-or-later
// line_search.cpp for whole vectors. Included once per instruction set; see stripe_simd.cpp.
#if defined(FACULA_ROW_SEARCH_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef FACULA_ROW_SEARCH_SIMD
#undef FACULA_ROW_SEARCH_SIMD
#else
#define FACULA_ROW_SEARCH_SIMD
#endif

#include <hwy/aligned_allocator.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::ScalableTag<std::uint8_t>;
using VBytes = hn::Vec<Bytes>;

/// Some pixels as bytes, 0 to 255.
HWY_INLINE VBytes load_pixels(const std::uint8_t* from) {
  return hn::LoadU(Bytes(), from);
}

HWY_INLINE VBytes load_pixels(const std::int16_t* from) {
  const hn::Repartition<std::int16_t, Bytes> d16;
  const hn::Half<Bytes> half;
  return hn::Combine(Bytes(),
                     hn::DemoteTo(half, hn::LoadU(d16, from + hn::Lanes(d16))),
                     hn::DemoteTo(half, hn::LoadU(d16, from)));
}

inline int byte_of(int value) {
  return value < 0 ? 0 : value > 255 ? 255 : value;
}

template <typename Value>
using FourRows = std::array<const Value*, kRowsAtOnce>;

/// Room for the boxes of one group of rows, with what lies off both ends of the row.
class SearchRoom {
 public:
  static constexpr std::size_t kOff = 128;  ///< more than any distance and any vector

  void reserve(int cols) {
    const std::size_t need = (static_cast<std::size_t>(cols) / 2 + 3 * kOff) / kOff * kOff;
    if (size_ >= need) return;
    size_ = need;
    bytes_ = hwy::AllocateAligned<std::uint8_t>(3 * need);
  }
  std::uint8_t* columns() { return bytes_.get() + kOff; }
  std::uint8_t* boxes() { return bytes_.get() + size_ + kOff; }
  std::uint8_t* over() { return bytes_.get() + 2 * size_; }

 private:
  std::size_t size_ = 0;
  hwy::AlignedFreeUniquePtr<std::uint8_t[]> bytes_;
};

template <typename Value>
HWY_INLINE VBytes level_of(const FourRows<Value>& rows, std::size_t c) {
  const auto upper = hn::AverageRound(load_pixels(rows[0] + c), load_pixels(rows[1] + c));
  const auto lower = hn::AverageRound(load_pixels(rows[2] + c), load_pixels(rows[3] + c));
  return hn::AverageRound(upper, lower);
}

template <int kHalvings, typename Value>
HWY_INLINE void store_columns(const FourRows<Value>& rows, std::size_t c, std::uint8_t* to) {
  const Bytes d;
  const auto left = level_of(rows, c);
  const auto right = level_of(rows, c + hn::Lanes(d));
  const auto pairs =
      hn::AverageRound(hn::ConcatEven(d, right, left), hn::ConcatOdd(d, right, left));
  if (kHalvings == 1) {
    hn::StoreU(pairs, d, to);
  } else {
    const auto fours =
        hn::AverageRound(hn::ConcatEven(d, pairs, pairs), hn::ConcatOdd(d, pairs, pairs));
    const hn::Half<Bytes> half;
    hn::StoreU(hn::LowerHalf(half, fours), half, to);
  }
}

template <typename Value>
HWY_INLINE std::uint8_t level_at(const FourRows<Value>& rows, std::size_t c) {
  const int upper = (byte_of(rows[0][c]) + byte_of(rows[1][c]) + 1) >> 1;
  const int lower = (byte_of(rows[2][c]) + byte_of(rows[3][c]) + 1) >> 1;
  return static_cast<std::uint8_t>((upper + lower + 1) >> 1);
}

/// Rows into one, columns into pairs or fours; the row goes on level beyond its ends.
template <int kHalvings, typename Value>
HWY_INLINE void average_columns(const FourRows<Value>& rows, std::size_t cols, SearchRoom& room) {
  const Bytes d;
  const std::size_t step = 2 * hn::Lanes(d);
  std::uint8_t* to = room.columns();
  std::size_t c = 0;
  for (; c + step <= cols; c += step) store_columns<kHalvings>(rows, c, to + (c >> kHalvings));
  if (c < cols) {
    Value tail[kRowsAtOnce][2 * HWY_MAX_BYTES];
    FourRows<Value> tails;
    for (std::size_t i = 0; i < kRowsAtOnce; ++i) {
      std::copy(rows[i] + c, rows[i] + cols, tail[i]);
      std::fill(tail[i] + (cols - c), tail[i] + step, rows[i][cols - 1]);
      tails[i] = tail[i];
    }
    store_columns<kHalvings>(tails, 0, to + (c >> kHalvings));
  }
  constexpr std::size_t kEdge = 32;
  std::memset(to - kEdge, level_at(rows, 0), kEdge);
  const std::size_t own = (cols + (std::size_t{1} << kHalvings) - 1) >> kHalvings;
  std::memset(to + own, level_at(rows, cols - 1), kEdge);
}

/// Pairs or fours into boxes: [first, last) and what they are held against.
HWY_INLINE const std::uint8_t* average_boxes(const LineSearch& search,
                                             int first,
                                             int last,
                                             SearchRoom& room) {
  const Bytes d;
  std::uint8_t* from = room.columns();
  std::uint8_t* to = room.boxes();
  for (int level = 0; level < search.levels; ++level) {
    const int end = last + search.distance + (1 << search.levels);
    for (int j = first - search.distance; j < end; j += static_cast<int>(hn::Lanes(d))) {
      const auto next = hn::LoadU(d, from + j + (1 << level));
      hn::StoreU(hn::AverageRound(hn::LoadU(d, from + j), next), d, to + j);
    }
    std::swap(from, to);
  }
  return from;
}

/// The highest of what the boxes exceed those beside them by, and the sum of it, each at most
/// `clip`.
struct Heights {
  int highest = 0;
  int clipped_sum = 0;
};

/// What each box exceeds those beside it by, into room.over().
HWY_INLINE Heights hold_against_sides(const std::uint8_t* boxes,
                                      const LineSearch& search,
                                      BoxRange range,
                                      int clip,
                                      SearchRoom& room) {
  const Bytes d;
  const hn::Repartition<std::uint64_t, Bytes> d64;
  const int lanes = static_cast<int>(hn::Lanes(d));
  std::uint8_t* over = room.over();
  const auto most = hn::Set(d, static_cast<std::uint8_t>(clip));
  auto highest = hn::Zero(d);
  auto sum = hn::Zero(d64);
  for (int j = range.first; j < range.last; j += lanes) {
    const auto beside = hn::Max(hn::LoadU(d, boxes + j - search.distance),
                                hn::LoadU(d, boxes + j + search.distance));
    auto above = hn::SaturatedSub(hn::LoadU(d, boxes + j), beside);
    if (range.last - j < lanes) {
      above = hn::IfThenElseZero(hn::FirstN(d, static_cast<std::size_t>(range.last - j)), above);
    }
    highest = hn::Max(highest, above);
    sum = hn::Add(sum, hn::SumsOf8(hn::Min(most, above)));
    hn::Store(above, d, over + (j - range.first));
  }
  const hn::Repartition<std::uint16_t, Bytes> d16;
  const auto both = hn::BitCast(d16, highest);
  const auto of_two =
      hn::Max(hn::And(both, hn::Set(d16, std::uint16_t{0xFF})), hn::ShiftRight<8>(both));
  return {static_cast<int>(hn::GetLane(hn::MaxOfLanes(d16, of_two))),
          static_cast<int>(hn::GetLane(hn::SumOfLanes(d64, sum)))};
}

HWY_INLINE int first_equal(const std::uint8_t* values, int value) {
  const Bytes d;
  const auto wanted = hn::Set(d, static_cast<std::uint8_t>(value));
  for (int i = 0;; i += static_cast<int>(hn::Lanes(d))) {
    const auto equal = hn::Eq(hn::LoadU(d, values + i), wanted);
    const auto at = hn::FindFirstTrue(d, equal);
    if (at >= 0) return i + static_cast<int>(at);
  }
}

HWY_INLINE int sum_clipped(const std::uint8_t* values, int count, int clip) {
  const Bytes d;
  const hn::Repartition<std::uint64_t, Bytes> d64;
  const auto most = hn::Set(d, static_cast<std::uint8_t>(clip));
  const int lanes = static_cast<int>(hn::Lanes(d));
  auto sum = hn::Zero(d64);
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    sum = hn::Add(sum, hn::SumsOf8(hn::Min(most, hn::LoadU(d, values + i))));
  }
  if (i < count) {
    const auto rest = hn::FirstN(d, static_cast<std::size_t>(count - i));
    const auto v = hn::IfThenElseZero(rest, hn::LoadU(d, values + i));
    sum = hn::Add(sum, hn::SumsOf8(hn::Min(most, v)));
  }
  return static_cast<int>(hn::GetLane(hn::SumOfLanes(d64, sum)));
}

HWY_NOINLINE float noise_beside(
    const std::uint8_t* over, int count, int first, int last, const RowNoiseScale& scale) {
  const int kept = count - (last - first);
  int sum = 0;
  for (int step = 0; step < RowNoiseScale::kSteps; ++step) {
    sum = sum_clipped(over, count, scale.clip(step)) -
          sum_clipped(over + first, last - first, scale.clip(step));
    if (scale.fits(step, sum, kept)) return scale.noise(step, sum, kept);
  }
  return scale.noise(RowNoiseScale::kSteps - 1, sum, kept);
}

/// search_rows() for rows of `cols` columns that begin at column 0, many groups at a time, step by
/// step: what one step stores has then left the processor when the next one reads it.
class RowSearch {
 public:
  static constexpr int kMostGroups = kBatchRows;

  RowSearch(const LineSearch& search, BoxRange range, int cols)
      : search_(search), range_(range), cols_(cols) {}

  template <typename Value>
  HWY_INLINE void search(const FourRows<Value>* groups,
                         int count,
                         const RowNoiseScale& scale,
                         LinePlace* places) {
    for (int first = 0; first < count; first += kAtOnce) {
      search_some(groups + first, std::min(kAtOnce, count - first), scale, places + first);
    }
  }

 private:
  static constexpr int kAtOnce = kBatchRows / kRowsAtOnce;

  template <typename Value>
  HWY_NOINLINE void search_some(const FourRows<Value>* groups,
                                int count,
                                const RowNoiseScale& scale,
                                LinePlace* places) {
    std::array<const std::uint8_t*, kAtOnce> boxes;
    std::array<Heights, kAtOnce> heights;
    for (int g = 0; g < count; ++g) {
      rooms_[at(g)].reserve(cols_);
      if (search_.halvings == 1) {
        average_columns<1>(groups[g], static_cast<std::size_t>(cols_), rooms_[at(g)]);
      } else {
        average_columns<2>(groups[g], static_cast<std::size_t>(cols_), rooms_[at(g)]);
      }
    }
    for (int g = 0; g < count; ++g) {
      boxes[at(g)] = average_boxes(search_, range_.first, range_.last, rooms_[at(g)]);
    }
    for (int g = 0; g < count; ++g) {
      heights[at(g)] =
          hold_against_sides(boxes[at(g)], search_, range_, scale.clip(0), rooms_[at(g)]);
    }
    for (int g = 0; g < count; ++g) {
      places[g] = place_of(heights[at(g)], rooms_[at(g)].over(), scale);
    }
  }

  static std::size_t at(int g) { return static_cast<std::size_t>(g); }

  HWY_INLINE LinePlace place_of(const Heights& heights,
                                const std::uint8_t* over,
                                const RowNoiseScale& scale) const {
    if (heights.highest == 0) return {};
    const int top = first_equal(over, heights.highest);
    const int count = range_.last - range_.first;
    const int reach = search_.own_reach();
    const int first = std::max(0, top - reach);
    const int last = std::min(count, top + reach + 1);
    const int kept = count - (last - first);
    LinePlace place = {search_.middle(range_.first + top), heights.highest, 0};
    // With the line's own in it the sum is no less.
    if (kept >= 32 && !scale.fits(0, heights.clipped_sum, kept)) {
      place.row_noise = noise_beside(over, count, first, last, scale);
    }
    return place;
  }

  LineSearch search_;
  BoxRange range_;
  int cols_;
  std::array<SearchRoom, kAtOnce> rooms_;
};

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#endif  // FACULA_ROW_SEARCH_SIMD
