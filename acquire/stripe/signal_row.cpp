// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/signal_row.hpp>

#define HWY_WANT_AVX3_DL 1
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "facula/acquire/stripe/signal_row.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifdef HWY_TARGET  // what follows comes after the above, however includes are sorted
#include <facula/acquire/stripe/signal_row_simd-inl.hpp>
#endif

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

void read_signal_row_here(const ImageView8& frame,
                          const ImageView8& background,
                          int r,
                          Channel channel,
                          std::int16_t* to) {
  read_signal_row_of(frame, background, r, channel, to);
}

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace facula {

HWY_EXPORT(read_signal_row_here);

void read_signal_row(
    ImageView8 frame, ImageView8 background, int r, Channel channel, std::int16_t* values) {
  HWY_DYNAMIC_DISPATCH(read_signal_row_here)(frame, background, r, channel, values);
}

}  // namespace facula
#endif  // HWY_ONCE
