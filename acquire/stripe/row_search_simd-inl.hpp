// SPDX-License-Identifier: GPL-3.0-or-later
// line_search.cpp for whole vectors. Included once per instruction set; see stripe_simd.cpp.
#if defined(FACULA_ROW_SEARCH_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef FACULA_ROW_SEARCH_SIMD
#undef FACULA_ROW_SEARCH_SIMD
#else
#define FACULA_ROW_SEARCH_SIMD
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::ScalableTag<std::uint8_t>;
using VBytes = hn::Vec<Bytes>;

/// Some pixels as bytes, 0 to 255.
HWY_INLINE VBytes LoadPixels(const std::uint8_t* from) {
  return hn::LoadU(Bytes(), from);
}

HWY_INLINE VBytes LoadPixels(const std::int16_t* from) {
  const hn::Repartition<std::int16_t, Bytes> d16;
  const hn::Half<Bytes> half;
  return hn::Combine(Bytes(),
                     hn::DemoteTo(half, hn::LoadU(d16, from + hn::Lanes(d16))),
                     hn::DemoteTo(half, hn::LoadU(d16, from)));
}

inline int ByteOf(int value) {
  return value < 0 ? 0 : value > 255 ? 255 : value;
}

template <typename Value>
using FourRows = std::array<const Value*, kRowsAtOnce>;

/// Room for the boxes of one group of rows, with what lies off both ends of the row.
class SearchRoom {
 public:
  static constexpr std::size_t kOff = 128;  ///< more than any distance and any vector

  void Reserve(int cols) {
    const std::size_t need = static_cast<std::size_t>(cols) / 2 + 3 * kOff;
    if (pairs_.size() < need) {
      pairs_.resize(need);
      boxes_.resize(need);
      over_.resize(need);
    }
  }
  std::uint8_t* pairs() { return pairs_.data() + kOff; }
  std::uint8_t* boxes() { return boxes_.data() + kOff; }
  std::uint8_t* over() { return over_.data(); }

 private:
  std::vector<std::uint8_t> pairs_;
  std::vector<std::uint8_t> boxes_;
  std::vector<std::uint8_t> over_;
};

template <typename Value>
HWY_INLINE VBytes LevelOf(const FourRows<Value>& rows, std::size_t c) {
  const auto upper = hn::AverageRound(LoadPixels(rows[0] + c), LoadPixels(rows[1] + c));
  const auto lower = hn::AverageRound(LoadPixels(rows[2] + c), LoadPixels(rows[3] + c));
  return hn::AverageRound(upper, lower);
}

template <typename Value>
HWY_INLINE void StorePairs(const FourRows<Value>& rows, std::size_t c, std::uint8_t* pairs) {
  const Bytes d;
  const auto left = LevelOf(rows, c);
  const auto right = LevelOf(rows, c + hn::Lanes(d));
  hn::StoreU(hn::AverageRound(hn::ConcatEven(d, right, left), hn::ConcatOdd(d, right, left)),
             d,
             pairs);
}

template <typename Value>
HWY_INLINE std::uint8_t LevelAt(const FourRows<Value>& rows, std::size_t c) {
  const int upper = (ByteOf(rows[0][c]) + ByteOf(rows[1][c]) + 1) >> 1;
  const int lower = (ByteOf(rows[2][c]) + ByteOf(rows[3][c]) + 1) >> 1;
  return static_cast<std::uint8_t>((upper + lower + 1) >> 1);
}

/// Rows into one, columns into pairs; the row goes on level beyond its ends.
template <typename Value>
HWY_INLINE void AveragePairs(const FourRows<Value>& rows, std::size_t cols, SearchRoom& room) {
  const Bytes d;
  const std::size_t step = 2 * hn::Lanes(d);
  std::uint8_t* pairs = room.pairs();
  std::size_t c = 0;
  for (; c + step <= cols; c += step) StorePairs(rows, c, pairs + c / 2);
  if (c < cols) {
    Value tail[kRowsAtOnce][2 * HWY_MAX_BYTES];
    FourRows<Value> tails;
    for (std::size_t i = 0; i < kRowsAtOnce; ++i) {
      std::copy(rows[i] + c, rows[i] + cols, tail[i]);
      std::fill(tail[i] + (cols - c), tail[i] + step, rows[i][cols - 1]);
      tails[i] = tail[i];
    }
    StorePairs(tails, 0, pairs + c / 2);
  }
  constexpr std::size_t kEdge = 32;
  std::memset(pairs - kEdge, LevelAt(rows, 0), kEdge);
  std::memset(pairs + (cols + 1) / 2, LevelAt(rows, cols - 1), kEdge);
}

/// Pairs into boxes: [first, last) and what they are held against.
HWY_INLINE const std::uint8_t* AverageBoxes(const LineSearch& search,
                                            int first,
                                            int last,
                                            SearchRoom& room) {
  const Bytes d;
  std::uint8_t* from = room.pairs();
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

/// What each box exceeds those beside it by, into room.over(); the highest of it.
HWY_INLINE int HoldAgainstSides(
    const std::uint8_t* boxes, const LineSearch& search, int first, int last, SearchRoom& room) {
  const Bytes d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  std::uint8_t* over = room.over();
  auto highest = hn::Zero(d);
  for (int j = first; j < last; j += lanes) {
    const auto beside = hn::Max(hn::LoadU(d, boxes + j - search.distance),
                                hn::LoadU(d, boxes + j + search.distance));
    auto above = hn::SaturatedSub(hn::LoadU(d, boxes + j), beside);
    if (last - j < lanes) {
      above = hn::IfThenElseZero(hn::FirstN(d, static_cast<std::size_t>(last - j)), above);
    }
    highest = hn::Max(highest, above);
    hn::StoreU(above, d, over + (j - first));
  }
  const hn::Repartition<std::uint16_t, Bytes> d16;
  const auto both = hn::BitCast(d16, highest);
  const auto of_two =
      hn::Max(hn::And(both, hn::Set(d16, std::uint16_t{0xFF})), hn::ShiftRight<8>(both));
  return hn::GetLane(hn::MaxOfLanes(d16, of_two));
}

HWY_INLINE int FirstEqual(const std::uint8_t* values, int value) {
  const Bytes d;
  const auto wanted = hn::Set(d, static_cast<std::uint8_t>(value));
  for (int i = 0;; i += static_cast<int>(hn::Lanes(d))) {
    const auto equal = hn::Eq(hn::LoadU(d, values + i), wanted);
    const auto at = hn::FindFirstTrue(d, equal);
    if (at >= 0) return i + static_cast<int>(at);
  }
}

HWY_INLINE int SumClipped(const std::uint8_t* values, int count, int clip) {
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

HWY_INLINE float NoiseBeside(const std::uint8_t* over,
                             int count,
                             int top,
                             int reach,
                             const RowNoiseScale& scale) {
  const int first = std::max(0, top - reach);
  const int last = std::min(count, top + reach + 1);
  const int kept = count - (last - first);
  if (kept < 32) return 0;
  int sum = 0;
  for (int step = 0; step < RowNoiseScale::kSteps; ++step) {
    sum = SumClipped(over, count, scale.clip(step)) -
          SumClipped(over + first, last - first, scale.clip(step));
    if (scale.fits(step, sum, kept)) return scale.noise(step, sum, kept);
  }
  return scale.noise(RowNoiseScale::kSteps - 1, sum, kept);
}

/// search_rows() for rows of `cols` columns that begin at column 0.
template <typename Value>
HWY_NOINLINE LinePlace SearchRows(const FourRows<Value>& rows,
                                  int cols,
                                  const LineSearch& search,
                                  const BoxRange& range,
                                  const RowNoiseScale& scale,
                                  SearchRoom& room) {
  AveragePairs(rows, static_cast<std::size_t>(cols), room);
  const std::uint8_t* boxes = AverageBoxes(search, range.first, range.last, room);
  LinePlace place;
  const int highest = HoldAgainstSides(boxes, search, range.first, range.last, room);
  if (highest == 0) return place;
  const int top = FirstEqual(room.over(), highest);
  place.height = highest;
  place.column = search.middle(range.first + top);
  const int reach = search.distance + (1 << search.levels);
  place.row_noise = NoiseBeside(room.over(), range.last - range.first, top, reach, scale);
  return place;
}

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#endif  // FACULA_ROW_SEARCH_SIMD
