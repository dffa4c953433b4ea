// SPDX-License-Identifier: GPL-3.0-or-later
// read_signal_row() of signal_row.hpp. Included once per instruction set; see stripe_simd.cpp and
// signal_row.cpp.
#if defined(FACULA_SIGNAL_ROW_SIMD) == defined(HWY_TARGET_TOGGLE)
#ifdef FACULA_SIGNAL_ROW_SIMD
#undef FACULA_SIGNAL_ROW_SIMD
#else
#define FACULA_SIGNAL_ROW_SIMD
#endif

#include <facula/acquire/stripe/channel_value.hpp>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// channel_value() of whole vectors.
template <Channel kChannel, class V>
HWY_INLINE V channel_of(V b, V g, V r) {
  const hn::DFromV<V> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  switch (kChannel) {
    case Channel::kRed:
      return r;
    case Channel::kGreen:
      return g;
    case Channel::kBlue:
      return b;
    case Channel::kRedExcess:
      return hn::Sub(r, hn::Max(g, b));
    case Channel::kGreenExcess:
      return hn::Sub(g, hn::Max(r, b));
    case Channel::kBlueExcess:
      return hn::Sub(b, hn::Max(r, g));
    case Channel::kMaximum:
      return hn::Max(r, hn::Max(g, b));
    case Channel::kGrey:
      break;
  }
  const auto weighed = [&](V v, int weight) {
    return hn::BitCast(du, hn::Mul(v, hn::Set(d, static_cast<std::int16_t>(weight))));
  };
  const auto sum = hn::Add(hn::Add(weighed(r, kGreyRed), weighed(g, kGreyGreen)),
                           hn::Add(weighed(b, kGreyBlue), hn::Set(du, std::uint16_t{128})));
  return hn::BitCast(d, hn::ShiftRight<8>(sum));
}

/// One row of colour pixels, or what two of them differ by where `dark` is not null.
template <Channel kChannel>
HWY_INLINE void read_colour_row(const std::uint8_t* lit,
                                const std::uint8_t* dark,
                                int cols,
                                std::int16_t* values) {
  int c = 0;
#if HWY_TARGET != HWY_SCALAR
  const hn::ScalableTag<std::int16_t> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto read = [&](const std::uint8_t* from) {
    hn::Vec<decltype(bytes)> b;
    hn::Vec<decltype(bytes)> g;
    hn::Vec<decltype(bytes)> r;
    hn::LoadInterleaved3(bytes, from, b, g, r);
    return channel_of<kChannel>(hn::PromoteTo(d, b), hn::PromoteTo(d, g), hn::PromoteTo(d, r));
  };
  for (; c + lanes <= cols; c += lanes) {
    auto value = read(lit + 3 * c);
    if (dark != nullptr) value = hn::Sub(value, read(dark + 3 * c));
    hn::StoreU(value, d, values + c);
  }
#endif
  const auto at = [&](const std::uint8_t* p) { return channel_value<kChannel>(p[0], p[1], p[2]); };
  for (; c < cols; ++c) {
    const int value = at(lit + 3 * c) - (dark != nullptr ? at(dark + 3 * c) : 0);
    values[c] = static_cast<std::int16_t>(value);
  }
}

HWY_INLINE void read_grey_row(const std::uint8_t* lit,
                              const std::uint8_t* dark,
                              int cols,
                              std::int16_t* values) {
  int c = 0;
#if HWY_TARGET != HWY_SCALAR
  const hn::ScalableTag<std::int16_t> d;
  const hn::Rebind<std::uint8_t, decltype(d)> bytes;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (; c + lanes <= cols; c += lanes) {
    auto value = hn::PromoteTo(d, hn::LoadU(bytes, lit + c));
    if (dark != nullptr) value = hn::Sub(value, hn::PromoteTo(d, hn::LoadU(bytes, dark + c)));
    hn::StoreU(value, d, values + c);
  }
#endif
  for (; c < cols; ++c) {
    values[c] = static_cast<std::int16_t>(lit[c] - (dark != nullptr ? dark[c] : 0));
  }
}

HWY_INLINE void read_signal_row_of(const ImageView8& frame,
                                   const ImageView8& background,
                                   int r,
                                   Channel channel,
                                   std::int16_t* to) {
  const std::uint8_t* lit = frame.row(r);
  const std::uint8_t* dark = background.empty() ? nullptr : background.row(r);
  if (frame.channels != 3) return read_grey_row(lit, dark, frame.cols, to);
  // Written out: a function that a generic lambda calls has lost its instruction set.
  switch (channel) {
    case Channel::kGrey:
      return read_colour_row<Channel::kGrey>(lit, dark, frame.cols, to);
    case Channel::kRed:
      return read_colour_row<Channel::kRed>(lit, dark, frame.cols, to);
    case Channel::kGreen:
      return read_colour_row<Channel::kGreen>(lit, dark, frame.cols, to);
    case Channel::kBlue:
      return read_colour_row<Channel::kBlue>(lit, dark, frame.cols, to);
    case Channel::kRedExcess:
      return read_colour_row<Channel::kRedExcess>(lit, dark, frame.cols, to);
    case Channel::kGreenExcess:
      return read_colour_row<Channel::kGreenExcess>(lit, dark, frame.cols, to);
    case Channel::kBlueExcess:
      return read_colour_row<Channel::kBlueExcess>(lit, dark, frame.cols, to);
    case Channel::kMaximum:
      return read_colour_row<Channel::kMaximum>(lit, dark, frame.cols, to);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#endif  // FACULA_SIGNAL_ROW_SIMD
