// SPDX-License-Identifier: GPL-3.0-or-later
// Windows of many rows side by side, and settle() of line_search.cpp on them: one lane is one row.
// Included once per instruction set; see stripe_simd.cpp.
#if defined(FACULA_ROW_WINDOW_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef FACULA_ROW_WINDOW_SIMD
#undef FACULA_ROW_WINDOW_SIMD
#else
#define FACULA_ROW_WINDOW_SIMD
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Shorts = hn::ScalableTag<std::int16_t>;
using Words = hn::ScalableTag<std::int32_t>;
using VShorts = hn::Vec<Shorts>;
using VWords = hn::Vec<Words>;
using EightShorts = hn::Full128<std::int16_t>;

/// Where the 8 pixels numbered `eight` of row q lie among those of the others, so that vectors of
/// `Lane` sized numbers can be turned about within their 128 bits: first by rows of one vector,
/// then by eights, then by what has to be turned, last by the 128 bits.
template <typename Lane>
struct WindowLayout {
  static constexpr int kTurned = static_cast<int>(16 / sizeof(Lane));  ///< rows in 128 bits

  int eights;
  int lanes = static_cast<int>(hn::Lanes(hn::ScalableTag<Lane>()));  ///< rows in a vector

  int at(int q, int eight) const {
    const int in_vector = q % lanes;
    const int vector = (q / lanes * eights + eight) * kTurned + in_vector % kTurned;
    return (vector * (lanes / kTurned) + in_vector / kTurned) * 8;
  }
};

using WindowPixels = std::array<std::int16_t, kBatchRows * kMostWindow>;

HWY_INLINE hn::Vec<EightShorts> load_eight(const std::uint8_t* from) {
  const hn::Rebind<std::uint8_t, EightShorts> bytes;
  return hn::PromoteTo(EightShorts(), hn::LoadU(bytes, from));
}

HWY_INLINE hn::Vec<EightShorts> load_eight(const std::int16_t* from) {
  return hn::LoadU(EightShorts(), from);
}

/// Copies the pixels from column `from` on; beyond what is known the row goes on level.
template <typename Value, typename Lane>
HWY_INLINE void copy_window(const RowPart<Value>& row,
                            int from,
                            int q,
                            const WindowLayout<Lane>& layout,
                            std::int16_t* pixels) {
  const int width = 8 * layout.eights;
  Value level[kMostWindow];
  const Value* source = row.values + (from - row.begin);
  if (HWY_UNLIKELY(from < row.begin || from + width > row.end)) {
    for (int i = 0; i < width; ++i) {
      level[i] = row.values[std::clamp(from + i, row.begin, row.end - 1) - row.begin];
    }
    source = level;
  }
  std::int16_t* to = pixels + layout.at(q, 0);
  const int step = layout.lanes * 8;
  for (int i = 0; i < layout.eights; ++i) {
    hn::Store(load_eight(source + 8 * i), EightShorts(), to + i * step);
  }
}

/// Eight vectors of 8 pixels each become eight vectors of one column each.
HWY_INLINE void turn_eights(const std::int16_t* from, VShorts* columns) {
  const Shorts d;
  const std::size_t lanes = hn::Lanes(d);
  VShorts a[8];
  VShorts b[8];
  for (std::size_t i = 0; i < 8; ++i) a[i] = hn::Load(d, from + i * lanes);
  for (std::size_t i = 0; i < 4; ++i) {
    b[2 * i] = hn::InterleaveLower(d, a[i], a[i + 4]);
    b[2 * i + 1] = hn::InterleaveUpper(d, a[i], a[i + 4]);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    a[2 * i] = hn::InterleaveLower(d, b[i], b[i + 4]);
    a[2 * i + 1] = hn::InterleaveUpper(d, b[i], b[i + 4]);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    columns[2 * i] = hn::InterleaveLower(d, a[i], a[i + 4]);
    columns[2 * i + 1] = hn::InterleaveUpper(d, a[i], a[i + 4]);
  }
}

/// Four vectors of 8 pixels each become four vectors of two neighbouring columns each.
HWY_INLINE void turn_pairs(const std::int16_t* from, VWords* pairs) {
  const Words d;
  const Shorts d16;
  const std::size_t lanes = hn::Lanes(d16);
  VWords a[4];
  VWords b[4];
  for (std::size_t i = 0; i < 4; ++i) a[i] = hn::BitCast(d, hn::Load(d16, from + i * lanes));
  for (std::size_t i = 0; i < 2; ++i) {
    b[2 * i] = hn::InterleaveLower(d, a[i], a[i + 2]);
    b[2 * i + 1] = hn::InterleaveUpper(d, a[i], a[i + 2]);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    pairs[2 * i] = hn::InterleaveLower(d, b[i], b[i + 2]);
    pairs[2 * i + 1] = hn::InterleaveUpper(d, b[i], b[i + 2]);
  }
}

/// Rows that are settled together: what is known of them and what comes of it.
template <typename Value>
struct SettleBatch {
  int count = 0;
  RowPart<Value> rows[kBatchRows];
  std::int16_t column[kBatchRows];             ///< where to look [px]
  alignas(64) std::int16_t shift[kBatchRows];  ///< of the settled line from there [px]
  alignas(64) std::int16_t drop[kBatchRows];   ///< 0 where there is none
};

/// settle() for all rows of a batch.
template <typename Value>
HWY_NOINLINE void settle_rows(const StripePlan& plan, SettleBatch<Value>& batch) {
  const Shorts d;
  const int reach = plan.search.reach;
  const int box = plan.search.box;
  alignas(64) WindowPixels pixels;
  const WindowLayout<std::int16_t> layout{plan.settle_eights};
  for (int q = 0; q < batch.count; ++q) {
    copy_window(batch.rows[q], batch.column[q] - plan.settle_reach, q, layout, pixels.data());
  }
  for (int q = 0; q < batch.count; q += layout.lanes) {
    // sums[k]: of all columns before k.
    VShorts sums[kMostWindow + 1];
    sums[0] = hn::Zero(d);
    for (int e = 0; e < layout.eights; ++e) {
      VShorts columns[8];
      turn_eights(pixels.data() + layout.at(q, e), columns);
      for (int i = 0; i < 8; ++i) sums[8 * e + i + 1] = hn::Add(sums[8 * e + i], columns[i]);
    }
    auto left = hn::Zero(d);
    auto best_drop = hn::Zero(d);
    auto best_shift = hn::Zero(d);
    for (int s = -reach; s <= reach; ++s) {
      const int k = plan.settle_reach + s;
      const auto right =
          hn::Sub(hn::Sub(sums[k + box + 1], sums[k + 1]), hn::Sub(sums[k], sums[k - box]));
      if (s > -reach) {
        const auto drop = hn::Sub(left, right);
        const auto falls = hn::AndNot(hn::Gt(right, hn::Zero(d)), hn::Gt(left, hn::Zero(d)));
        const auto better = hn::And(falls, hn::Gt(drop, best_drop));
        const auto in_left = hn::Lt(hn::Add(left, left), drop);
        const auto shift = hn::IfThenElse(in_left,
                                          hn::Set(d, static_cast<std::int16_t>(s - 1)),
                                          hn::Set(d, static_cast<std::int16_t>(s)));
        best_drop = hn::IfThenElse(better, drop, best_drop);
        best_shift = hn::IfThenElse(better, shift, best_shift);
      }
      left = right;
    }
    hn::Store(best_drop, d, batch.drop + q);
    hn::Store(best_shift, d, batch.shift + q);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#endif  // FACULA_ROW_WINDOW_SIMD
