// SPDX-License-Identifier: GPL-3.0-or-later
// fir_zero_crossing.cpp for many rows at once: one lane is one row. Sums of whole numbers are exact
// in any order; the rest is done in the same order, so that every number is the same to the last
// bit. Included once per instruction set; see stripe_simd.cpp.
#if defined(FACULA_FIR_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef FACULA_FIR_SIMD
#undef FACULA_FIR_SIMD
#else
#define FACULA_FIR_SIMD
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using VFloats = hn::Vec<Floats>;

/// Rows that are measured together, and the quantities of MeasuredRows and StripeCandidate.
template <typename Value>
struct MeasureBatch {
  int count = 0;
  RowPart<Value> rows[kBatchRows];
  alignas(64) std::int32_t column[kBatchRows];  ///< [px]
  alignas(64) std::int32_t found[kBatchRows];   ///< not 0 where something is measured
  alignas(64) float position[kBatchRows];
  alignas(64) float background[kBatchRows];
  alignas(64) float amplitude[kBatchRows];
  alignas(64) float width[kBatchRows];
  alignas(64) float snr_per_noise[kBatchRows];
  alignas(64) float sigma_per_noise[kBatchRows];
  alignas(64) float residual[kBatchRows];
  alignas(64) float residual_share[kBatchRows];
  alignas(64) float position_share[kBatchRows];
  alignas(64) float top_bend[kBatchRows];
  bool any_clipped = false;  ///< whether a value of 255 lies near a peak
};

/// Products of neighbouring 16-bit numbers, the two of each 32-bit lane added.
HWY_INLINE VWords mul_pairs(VWords a, VWords b) {
#if HWY_TARGET <= HWY_SSSE3 && HWY_ARCH_X86
  const Shorts d16;
  VWords unused = hn::Zero(Words());
  return hn::ReorderWidenMulAccumulate(
      Words(), hn::BitCast(d16, a), hn::BitCast(d16, b), unused, unused);
#else
  const auto lower =
      hn::Mul(hn::ShiftRight<16>(hn::ShiftLeft<16>(a)), hn::ShiftRight<16>(hn::ShiftLeft<16>(b)));
  return hn::Add(lower, hn::Mul(hn::ShiftRight<16>(a), hn::ShiftRight<16>(b)));
#endif
}

HWY_INLINE VWords weighed(const VWords* pairs, const PairWeights& weights) {
  const Words d;
  VWords even = hn::Zero(d);
  VWords odd = hn::Zero(d);
  int k = weights.first;
  for (; k + 2 <= weights.last; k += 2) {
    const auto i = static_cast<std::size_t>(k);
    even = hn::Add(even, mul_pairs(pairs[k], hn::Set(d, weights.pairs[i])));
    odd = hn::Add(odd, mul_pairs(pairs[k + 1], hn::Set(d, weights.pairs[i + 1])));
  }
  if (k < weights.last) {
    const auto i = static_cast<std::size_t>(k);
    even = hn::Add(even, mul_pairs(pairs[k], hn::Set(d, weights.pairs[i])));
  }
  return hn::Add(even, odd);
}

HWY_INLINE VFloats number(float value) {
  return hn::Set(Floats(), value);
}

HWY_INLINE VFloats at_least_zero(VFloats v) {
  return hn::IfThenElseZero(hn::Gt(v, hn::Zero(Floats())), v);
}

/// exp_near_zero() of fir_shape.hpp.
HWY_INLINE VFloats exp_near_zero(VFloats x) {
  const auto y = hn::Min(number(0.5F), hn::Max(number(-0.5F), hn::Mul(x, number(0.0625F))));
  auto p = hn::Add(number(1.0F / 6), hn::Mul(y, number(1.0F / 24)));
  p = hn::Add(number(0.5F), hn::Mul(y, p));
  p = hn::Add(number(1), hn::Mul(y, p));
  p = hn::Add(number(1), hn::Mul(y, p));
  p = hn::Mul(p, p);
  p = hn::Mul(p, p);
  p = hn::Mul(p, p);
  return hn::Mul(p, p);
}

/// One vector of rows: their pixels by pairs of columns, about the peaks.
class FirRows {
 public:
  FirRows(const StripePlan& plan, const VWords* pairs)
      : plan_(plan), s_(plan.shape), pairs_(pairs) {}

  /// The sums of whole numbers that FirZeroCrossing::measure() begins with.
  HWY_INLINE void weigh() {
    find_crossing();
    beside_ = weighed(pairs_, plan_.beside);
    smooth_ = weighed(pairs_, plan_.smooth);
    curved_ = weighed(pairs_, plan_.curvature);
    sum_ = weighed(pairs_, plan_.under);
    squares_ = sum_squares();
  }

  /// FirZeroCrossing::describe() for rows q on, but for the misfit.
  template <typename Value>
  HWY_INLINE void describe(int q, MeasureBatch<Value>& batch) {
    const Floats d;
    const auto level = hn::Mul(hn::ConvertTo(d, beside_), number(s_.per_background_pixel));
    const auto smooth = hn::ConvertTo(d, smooth_);
    const auto height = hn::Sub(hn::Mul(smooth, number(s_.smooth_unit)), level);
    const auto curved = hn::ConvertTo(d, curved_);
    const auto bend = hn::Mul(curved, number(s_.bend_unit));
    found_ = hn::And(found_, hn::Gt(bend, hn::Zero(d)));

    const auto drop = hn::Sub(left_, right_);
    const auto per_both = hn::Div(number(1), hn::Mul(drop, bend));
    const auto t = hn::Mul(hn::Mul(left_, bend), per_both);
    const auto d0 = hn::Add(from_, t);
    const auto ratio = hn::Mul(hn::Mul(height, drop), per_both);
    const auto four = hn::Mul(hn::Mul(number(4), ratio), hn::Mul(d0, d0));
    const auto root = hn::Sqrt(at_least_zero(hn::Sub(hn::Mul(ratio, ratio), four)));
    const auto variance = hn::Mul(number(0.5F), hn::Add(ratio, root));
    found_ = hn::And(found_, hn::Gt(variance, hn::Zero(d)));

    const auto inverse = hn::Div(number(1), variance);
    const auto cubic =
        hn::Mul(hn::Mul(t, hn::Sub(number(1), t)), hn::Sub(number(1), hn::Mul(number(2), t)));
    off_ = hn::Sub(d0, hn::Mul(hn::Mul(number(0.5F), inverse), cubic));
    const auto off2 = hn::Mul(off_, off_);
    const auto top = hn::Mul(height, exp_near_zero(hn::Mul(hn::Mul(number(0.5F), off2), inverse)));
    const auto top_bend = hn::Mul(top, inverse);
    const auto width2 = at_least_zero(hn::Sub(variance, number(s_.sigma2)));
    const auto drawn2 = hn::Max(number(s_.least_width2), width2);
    const auto wider2 = hn::Add(drawn2, number(0.5F * s_.sigma2));
    const auto area = hn::Mul(drawn2, wider2);
    const auto per_all = hn::Div(number(1), hn::Mul(area, top_bend));
    const auto per_width2 = hn::Mul(hn::Mul(wider2, top_bend), per_all);
    const auto share = hn::Mul(hn::Mul(hn::Mul(drawn2, drawn2), top_bend), per_all);
    const auto amplitude = hn::Mul(top, hn::Sqrt(hn::Mul(variance, per_width2)));
    const auto peak = hn::ConvertTo(d, hn::Load(Words(), batch.column + q));
    hn::Store(hn::Add(peak, off_), d, batch.position + q);
    hn::Store(level, d, batch.background + q);
    hn::Store(hn::Sqrt(width2), d, batch.width + q);
    hn::Store(hn::IfThenElseZero(hn::Gt(width2, hn::Zero(d)), amplitude), d, batch.amplitude + q);
    hn::Store(top_bend, d, batch.top_bend + q);
    hn::Store(hn::Mul(top_bend, number(s_.per_bend_noise)), d, batch.snr_per_noise + q);
    const auto sigma = hn::Mul(hn::Mul(number(s_.slope_noise), area), per_all);
    hn::Store(sigma, d, batch.sigma_per_noise + q);
    hn::Store(hn::Mul(share, hn::Sqrt(share)), d, batch.position_share + q);
    half_per_width2_ = hn::Mul(number(0.5F), per_width2);
    const Words words;
    hn::Store(hn::BitCast(words, hn::VecFromMask(d, found_)), words, batch.found + q);
    batch.any_clipped = batch.any_clipped || any_at_top();
  }

  /// FirZeroCrossing::measure_misfit() for rows q on.
  template <typename Value>
  HWY_INLINE void measure_misfit(int row, MeasureBatch<Value>& batch) const {
    const Floats d;
    const auto q = half_per_width2_;
    const auto change = exp_near_zero(hn::Mul(number(-2), q));
    const auto middle = exp_near_zero(hn::Mul(hn::Neg(hn::Mul(off_, off_)), q));
    Side right = {middle, factor_of(1, q)};
    Side left = {middle, factor_of(-1, q)};
    Sums sums;
    sums.g = middle;
    sums.gg = hn::Mul(middle, middle);
    sums.gs = hn::Mul(middle, pixel(plan_.fine_reach));
    for (int i = 1; i <= s_.misfit_reach; ++i) {
      add_next(right, change, pixel(plan_.fine_reach + i), sums);
      add_next(left, change, pixel(plan_.fine_reach - i), sums);
    }
    const auto per_pixel = number(s_.per_misfit_pixel);
    const auto s1 = hn::ConvertTo(d, sum_);
    const auto spread = hn::Sub(sums.gg, hn::Mul(hn::Mul(sums.g, sums.g), per_pixel));
    const auto together = hn::Sub(sums.gs, hn::Mul(hn::Mul(sums.g, s1), per_pixel));
    const auto pixels = hn::Set(Words(), 2 * s_.misfit_reach + 1);
    const auto whole = hn::Sub(hn::Mul(squares_, pixels), hn::Mul(sum_, sum_));
    const auto scatter = hn::Mul(hn::ConvertTo(d, whole), per_pixel);
    const auto rest = hn::Sub(scatter, hn::Div(hn::Mul(together, together), spread));
    hn::Store(hn::Mul(at_least_zero(rest), number(s_.per_misfit_freedom)), d, batch.residual + row);
    hn::Store(hn::Mul(sums.g, per_pixel), d, batch.residual_share + row);
  }

 private:
  HWY_INLINE void find_crossing() {
    const Words d;
    const Floats f;
    VWords slope[5];
    for (std::size_t i = 0; i < 5; ++i) slope[i] = weighed(pairs_, plan_.slope[i]);
    auto from = hn::Zero(d);
    auto to = hn::Zero(d);
    auto column = hn::Zero(d);
    auto found = hn::Lt(from, to);      // nowhere
    for (const int i : {3, 0, 2, 1}) {  // the nearest last, so that it stays
      const auto falls =
          hn::AndNot(hn::Gt(slope[i + 1], hn::Zero(d)), hn::Gt(slope[i], hn::Zero(d)));
      from = hn::IfThenElse(falls, slope[i], from);
      to = hn::IfThenElse(falls, slope[i + 1], to);
      column = hn::IfThenElse(falls, hn::Set(d, i - 2), column);
      found = hn::Or(found, falls);
    }
    from_ = hn::ConvertTo(f, column);
    left_ = hn::ConvertTo(f, from);
    right_ = hn::ConvertTo(f, to);
    found_ = hn::RebindMask(f, found);
  }

  HWY_INLINE VFloats pixel(int i) const {
    const VWords pair = pairs_[i / 2];
    const VWords pixel = hn::ShiftRight<16>(i % 2 == 0 ? hn::ShiftLeft<16>(pair) : pair);
    return hn::ConvertTo(Floats(), pixel);
  }

  struct Sums {
    VFloats g;
    VFloats gg;
    VFloats gs;
  };

  /// The profile on its way from the peak to one side.
  struct Side {
    VFloats g;
    VFloats factor;
  };

  HWY_INLINE VFloats factor_of(int side, VFloats q) const {
    const auto twice = hn::Mul(hn::Mul(number(static_cast<float>(side)), number(2)), off_);
    return exp_near_zero(hn::Mul(hn::Neg(q), hn::Sub(number(1), twice)));
  }

  HWY_INLINE static void add_next(Side& side, VFloats change, VFloats pixel, Sums& sums) {
    side.g = hn::Mul(side.g, side.factor);
    side.factor = hn::Mul(side.factor, change);
    sums.g = hn::Add(sums.g, side.g);
    sums.gg = hn::Add(sums.gg, hn::Mul(side.g, side.g));
    sums.gs = hn::Add(sums.gs, hn::Mul(side.g, pixel));
  }

  HWY_INLINE VWords sum_squares() const {
    const Words d;
    VWords sum = hn::Zero(d);
    for (int k = plan_.under.first; k < plan_.under.last; ++k) {
      const auto ones = hn::Set(d, plan_.under.pairs[static_cast<std::size_t>(k)]);
      // A weight of 1 turned into a mask of 16 bits: 0 less 1.
      const Shorts d16;
      const auto mask = hn::BitCast(d, hn::Neg(hn::BitCast(d16, ones)));
      const auto pair = hn::And(pairs_[k], mask);
      sum = hn::Add(sum, mul_pairs(pair, pair));
    }
    return sum;
  }

  /// Whether any row has a 255 within 3 columns of its peak.
  HWY_INLINE bool any_at_top() const {
    const Shorts d16;
    auto most = hn::Zero(d16);
    for (int k = (plan_.fine_reach - 3) / 2; k <= (plan_.fine_reach + 3) / 2; ++k) {
      most = hn::Max(most, hn::BitCast(d16, pairs_[k]));
    }
    return !hn::AllFalse(d16, hn::Eq(most, hn::Set(d16, std::int16_t{255})));
  }

  const StripePlan& plan_;
  const FirShape& s_;
  const VWords* pairs_;
  VFloats from_ = hn::Zero(Floats());
  VFloats left_ = hn::Zero(Floats());
  VFloats right_ = hn::Zero(Floats());
  VFloats off_ = hn::Zero(Floats());
  VFloats half_per_width2_ = hn::Zero(Floats());
  VWords beside_ = hn::Zero(Words());
  VWords smooth_ = hn::Zero(Words());
  VWords curved_ = hn::Zero(Words());
  VWords sum_ = hn::Zero(Words());
  VWords squares_ = hn::Zero(Words());
  hn::Mask<Floats> found_ = hn::Lt(hn::Zero(Floats()), hn::Zero(Floats()));
};

/// Rows of a batch about batch.column.
template <typename Value>
HWY_NOINLINE void measure_rows_of_batch(const StripePlan& plan, MeasureBatch<Value>& batch) {
  alignas(64) WindowPixels pixels;
  const WindowLayout<std::int32_t> layout{plan.fine_eights};
  for (int q = 0; q < batch.count; ++q) {
    copy_window(batch.rows[q], batch.column[q] - plan.fine_reach, q, layout, pixels.data());
  }
  batch.any_clipped = false;
  // Two vectors of rows at a time: where one waits for a division the other goes on.
  for (int q = 0; q < batch.count; q += 2 * layout.lanes) {
    const int next = q + layout.lanes;
    VWords pairs[2][kMostWindow / 2];
    for (int e = 0; e < layout.eights; ++e) {
      turn_pairs(pixels.data() + layout.at(q, e), pairs[0] + 4 * e);
      turn_pairs(pixels.data() + layout.at(next, e), pairs[1] + 4 * e);
    }
    FirRows first(plan, pairs[0]);
    FirRows second(plan, pairs[1]);
    first.weigh();
    second.weigh();
    first.describe(q, batch);
    second.describe(next, batch);
    first.measure_misfit(q, batch);
    second.measure_misfit(next, batch);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#endif  // FACULA_FIR_SIMD
