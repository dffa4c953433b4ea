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
HWY_INLINE VWords MulPairs(VWords a, VWords b) {
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

HWY_INLINE VWords Weighed(const VWords* pairs, const PairWeights& weights) {
  const Words d;
  VWords even = hn::Zero(d);
  VWords odd = hn::Zero(d);
  int k = weights.first;
  for (; k + 2 <= weights.last; k += 2) {
    const auto i = static_cast<std::size_t>(k);
    even = hn::Add(even, MulPairs(pairs[k], hn::Set(d, weights.pairs[i])));
    odd = hn::Add(odd, MulPairs(pairs[k + 1], hn::Set(d, weights.pairs[i + 1])));
  }
  if (k < weights.last) {
    const auto i = static_cast<std::size_t>(k);
    even = hn::Add(even, MulPairs(pairs[k], hn::Set(d, weights.pairs[i])));
  }
  return hn::Add(even, odd);
}

HWY_INLINE VFloats Number(float value) {
  return hn::Set(Floats(), value);
}

HWY_INLINE VFloats AtLeastZero(VFloats v) {
  return hn::IfThenElseZero(hn::Gt(v, hn::Zero(Floats())), v);
}

/// exp_near_zero() of fir_shape.hpp.
HWY_INLINE VFloats ExpNearZero(VFloats x) {
  const auto y = hn::Min(Number(0.5F), hn::Max(Number(-0.5F), hn::Mul(x, Number(0.0625F))));
  auto p = hn::Add(Number(1.0F / 6), hn::Mul(y, Number(1.0F / 24)));
  p = hn::Add(Number(0.5F), hn::Mul(y, p));
  p = hn::Add(Number(1), hn::Mul(y, p));
  p = hn::Add(Number(1), hn::Mul(y, p));
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
  HWY_INLINE void Weigh() {
    FindCrossing();
    beside_ = Weighed(pairs_, plan_.beside);
    smooth_ = Weighed(pairs_, plan_.smooth);
    curved_ = Weighed(pairs_, plan_.curvature);
    sum_ = Weighed(pairs_, plan_.under);
    squares_ = SumSquares();
  }

  /// FirZeroCrossing::describe() for rows q on, but for the misfit.
  template <typename Value>
  HWY_INLINE void Describe(int q, MeasureBatch<Value>& batch) {
    const Floats d;
    const auto level = hn::Mul(hn::ConvertTo(d, beside_), Number(s_.per_background_pixel));
    const auto smooth = hn::ConvertTo(d, smooth_);
    const auto height = hn::Sub(hn::Mul(smooth, Number(s_.smooth_unit)), level);
    const auto curved = hn::ConvertTo(d, curved_);
    const auto bend = hn::Mul(curved, Number(s_.bend_unit));
    found_ = hn::And(found_, hn::Gt(bend, hn::Zero(d)));

    const auto drop = hn::Sub(left_, right_);
    const auto per_both = hn::Div(Number(1), hn::Mul(drop, bend));
    const auto t = hn::Mul(hn::Mul(left_, bend), per_both);
    const auto d0 = hn::Add(from_, t);
    const auto ratio = hn::Mul(hn::Mul(height, drop), per_both);
    const auto four = hn::Mul(hn::Mul(Number(4), ratio), hn::Mul(d0, d0));
    const auto root = hn::Sqrt(AtLeastZero(hn::Sub(hn::Mul(ratio, ratio), four)));
    const auto variance = hn::Mul(Number(0.5F), hn::Add(ratio, root));
    found_ = hn::And(found_, hn::Gt(variance, hn::Zero(d)));

    const auto inverse = hn::Div(Number(1), variance);
    const auto cubic =
        hn::Mul(hn::Mul(t, hn::Sub(Number(1), t)), hn::Sub(Number(1), hn::Mul(Number(2), t)));
    off_ = hn::Sub(d0, hn::Mul(hn::Mul(Number(0.5F), inverse), cubic));
    const auto off2 = hn::Mul(off_, off_);
    const auto top = hn::Mul(height, ExpNearZero(hn::Mul(hn::Mul(Number(0.5F), off2), inverse)));
    const auto top_bend = hn::Mul(top, inverse);
    const auto width2 = AtLeastZero(hn::Sub(variance, Number(s_.sigma2)));
    const auto drawn2 = hn::Max(Number(s_.least_width2), width2);
    const auto wider2 = hn::Add(drawn2, Number(0.5F * s_.sigma2));
    const auto area = hn::Mul(drawn2, wider2);
    const auto per_all = hn::Div(Number(1), hn::Mul(area, top_bend));
    const auto per_width2 = hn::Mul(hn::Mul(wider2, top_bend), per_all);
    const auto share = hn::Mul(hn::Mul(hn::Mul(drawn2, drawn2), top_bend), per_all);
    const auto amplitude = hn::Mul(top, hn::Sqrt(hn::Mul(variance, per_width2)));
    const auto peak = hn::ConvertTo(d, hn::Load(Words(), batch.column + q));
    hn::Store(hn::Add(peak, off_), d, batch.position + q);
    hn::Store(level, d, batch.background + q);
    hn::Store(hn::Sqrt(width2), d, batch.width + q);
    hn::Store(hn::IfThenElseZero(hn::Gt(width2, hn::Zero(d)), amplitude), d, batch.amplitude + q);
    hn::Store(top_bend, d, batch.top_bend + q);
    hn::Store(hn::Mul(top_bend, Number(s_.per_bend_noise)), d, batch.snr_per_noise + q);
    const auto sigma = hn::Mul(hn::Mul(Number(s_.slope_noise), area), per_all);
    hn::Store(sigma, d, batch.sigma_per_noise + q);
    hn::Store(hn::Mul(share, hn::Sqrt(share)), d, batch.position_share + q);
    half_per_width2_ = hn::Mul(Number(0.5F), per_width2);
    const Words words;
    hn::Store(hn::BitCast(words, hn::VecFromMask(d, found_)), words, batch.found + q);
    batch.any_clipped = batch.any_clipped || AnyAtTop();
  }

  /// FirZeroCrossing::measure_misfit() for rows q on.
  template <typename Value>
  HWY_INLINE void MeasureMisfit(int row, MeasureBatch<Value>& batch) const {
    const Floats d;
    const auto q = half_per_width2_;
    const auto change = ExpNearZero(hn::Mul(Number(-2), q));
    const auto middle = ExpNearZero(hn::Mul(hn::Neg(hn::Mul(off_, off_)), q));
    Side right = {middle, FactorOf(1, q)};
    Side left = {middle, FactorOf(-1, q)};
    Sums sums;
    sums.g = middle;
    sums.gg = hn::Mul(middle, middle);
    sums.gs = hn::Mul(middle, Pixel(plan_.fine_reach));
    for (int i = 1; i <= s_.misfit_reach; ++i) {
      AddNext(right, change, Pixel(plan_.fine_reach + i), sums);
      AddNext(left, change, Pixel(plan_.fine_reach - i), sums);
    }
    const auto per_pixel = Number(s_.per_misfit_pixel);
    const auto s1 = hn::ConvertTo(d, sum_);
    const auto spread = hn::Sub(sums.gg, hn::Mul(hn::Mul(sums.g, sums.g), per_pixel));
    const auto together = hn::Sub(sums.gs, hn::Mul(hn::Mul(sums.g, s1), per_pixel));
    const auto pixels = hn::Set(Words(), 2 * s_.misfit_reach + 1);
    const auto whole = hn::Sub(hn::Mul(squares_, pixels), hn::Mul(sum_, sum_));
    const auto scatter = hn::Mul(hn::ConvertTo(d, whole), per_pixel);
    const auto rest = hn::Sub(scatter, hn::Div(hn::Mul(together, together), spread));
    hn::Store(hn::Mul(AtLeastZero(rest), Number(s_.per_misfit_freedom)), d, batch.residual + row);
    hn::Store(hn::Mul(sums.g, per_pixel), d, batch.residual_share + row);
  }

 private:
  HWY_INLINE void FindCrossing() {
    const Words d;
    const Floats f;
    VWords slope[5];
    for (std::size_t i = 0; i < 5; ++i) slope[i] = Weighed(pairs_, plan_.slope[i]);
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

  HWY_INLINE VFloats Pixel(int i) const {
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

  HWY_INLINE VFloats FactorOf(int side, VFloats q) const {
    const auto twice = hn::Mul(hn::Mul(Number(static_cast<float>(side)), Number(2)), off_);
    return ExpNearZero(hn::Mul(hn::Neg(q), hn::Sub(Number(1), twice)));
  }

  HWY_INLINE static void AddNext(Side& side, VFloats change, VFloats pixel, Sums& sums) {
    side.g = hn::Mul(side.g, side.factor);
    side.factor = hn::Mul(side.factor, change);
    sums.g = hn::Add(sums.g, side.g);
    sums.gg = hn::Add(sums.gg, hn::Mul(side.g, side.g));
    sums.gs = hn::Add(sums.gs, hn::Mul(side.g, pixel));
  }

  HWY_INLINE VWords SumSquares() const {
    const Words d;
    VWords sum = hn::Zero(d);
    for (int k = plan_.under.first; k < plan_.under.last; ++k) {
      const auto ones = hn::Set(d, plan_.under.pairs[static_cast<std::size_t>(k)]);
      // A weight of 1 turned into a mask of 16 bits: 0 less 1.
      const Shorts d16;
      const auto mask = hn::BitCast(d, hn::Neg(hn::BitCast(d16, ones)));
      const auto pair = hn::And(pairs_[k], mask);
      sum = hn::Add(sum, MulPairs(pair, pair));
    }
    return sum;
  }

  /// Whether any row has a 255 within 3 columns of its peak.
  HWY_INLINE bool AnyAtTop() const {
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
HWY_NOINLINE void MeasureRowsOfBatch(const StripePlan& plan, MeasureBatch<Value>& batch) {
  alignas(64) WindowPixels pixels;
  const WindowLayout<std::int32_t> layout{plan.fine_eights};
  for (int q = 0; q < batch.count; ++q) {
    CopyWindow(batch.rows[q], batch.column[q] - plan.fine_reach, q, layout, pixels.data());
  }
  batch.any_clipped = false;
  // Two vectors of rows at a time: where one waits for a division the other goes on.
  for (int q = 0; q < batch.count; q += 2 * layout.lanes) {
    const int next = q + layout.lanes;
    VWords pairs[2][kMostWindow / 2];
    for (int e = 0; e < layout.eights; ++e) {
      TurnPairs(pixels.data() + layout.at(q, e), pairs[0] + 4 * e);
      TurnPairs(pixels.data() + layout.at(next, e), pairs[1] + 4 * e);
    }
    FirRows first(plan, pairs[0]);
    FirRows second(plan, pairs[1]);
    first.Weigh();
    second.Weigh();
    first.Describe(q, batch);
    second.Describe(next, batch);
    first.MeasureMisfit(q, batch);
    second.MeasureMisfit(next, batch);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#endif  // FACULA_FIR_SIMD
