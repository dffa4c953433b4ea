// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/fir_clipped.hpp>
#include <facula/acquire/stripe/row_noise.hpp>
#include <facula/acquire/stripe/search_area.hpp>
#include <facula/acquire/stripe/stripe_plan.hpp>
#include <facula/acquire/stripe/stripe_simd.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#define HWY_WANT_AVX3_DL 1
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "facula/acquire/stripe/stripe_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#if HWY_TARGET != HWY_SCALAR
#include <facula/acquire/stripe/row_noise_simd-inl.hpp>
#include <facula/acquire/stripe/row_search_simd-inl.hpp>
#include <facula/acquire/stripe/row_window_simd-inl.hpp>
#include <facula/acquire/stripe/signal_row_simd-inl.hpp>
// Below row_window_simd-inl.hpp, whose vectors it names.
#include <facula/acquire/stripe/fir_simd-inl.hpp>
#include <facula/acquire/stripe/frame_simd-inl.hpp>
#endif

HWY_BEFORE_NAMESPACE();
namespace facula {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
// One lane a vector: nothing is gained over the plain functions.
bool measure_frame(const StripeView&, const StripeOptions&, StripeLocation&, MeasuredRows*) {
  return false;
}
bool locate_signal(const StripeSignal&, const StripeOptions&, StripeLocation&) {
  return false;
}
bool measure_signal(const StripeSignal&,
                    const StripeLocation&,
                    const StripeOptions&,
                    MeasuredRows&) {
  return false;
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace facula
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace facula {
namespace {

HWY_EXPORT(measure_frame);
HWY_EXPORT(locate_signal);
HWY_EXPORT(measure_signal);

constexpr int kLeastCols = 64;

}  // namespace

std::optional<MeasuredRows> measure_frame_simd(const StripeView& view,
                                               const StripeOptions& options,
                                               StripeLocation* location) {
  if (options.sigma > kMostSigma || view.frame.cols < kLeastCols) return {};
  check_pair(view.frame, view.background);
  StripeLocation located = StripeLocation::none(static_cast<std::size_t>(view.frame.rows));
  MeasuredRows rows(located.size(), 0);
  if (!HWY_DYNAMIC_DISPATCH(measure_frame)(view, options, located, &rows)) return {};
  if (location != nullptr) *location = std::move(located);
  return rows;
}

std::optional<StripeLocation> locate_stripe_simd(const StripeSignal& signal,
                                                 const StripeOptions& options) {
  if (options.sigma > kMostSigma || signal.cols() < kLeastCols || !signal.is_whole()) return {};
  StripeLocation location = StripeLocation::none(static_cast<std::size_t>(signal.rows()));
  if (!HWY_DYNAMIC_DISPATCH(locate_signal)(signal, options, location)) return {};
  return location;
}

std::optional<MeasuredRows> measure_rows_simd(const StripeSignal& signal,
                                              const StripeLocation& location,
                                              const StripeOptions& options) {
  if (options.sigma > kMostSigma) return {};
  MeasuredRows rows(location.size(), location.noise);
  if (!HWY_DYNAMIC_DISPATCH(measure_signal)(signal, location, options, rows)) return {};
  return rows;
}

}  // namespace facula
#endif  // HWY_ONCE
