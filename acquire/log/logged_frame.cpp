// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/log/logged_frame.hpp>

namespace facula {
namespace {

bool same_place(const StripeOptions& a, const StripeOptions& b) {
  return a.channel == b.channel && a.sigma == b.sigma && a.region.x == b.region.x &&
         a.region.y == b.region.y && a.region.width == b.region.width &&
         a.region.height == b.region.height;
}

}  // namespace

LoggedView log_view(const StripeView& images, const StripeOptions& options, int width) {
  options.check();
  require(!images.frame.empty(), "expected a frame with pixels, got an empty one");
  const bool transpose = options.direction == StripeDirection::kPerColumn;
  const StripeSignal signal(images.frame, images.background, options.channel, transpose);
  LoggedView view;
  view.location = needs_choice(images, options) ? choose_stripe(signal, images, options)
                                                : locate_stripe(signal, options);
  const StripeProfile profile = measure_stripe(signal, view.location, options);
  const WindowPlaces places = place_windows(profile, signal.cols(), width);
  view.windows = cut_windows(images.frame, images.background, places, transpose);
  for (std::size_t r = 0; r < places.begin.size(); ++r) {
    const int begin = places.begin[r];
    const int peak = view.location.peak[r];
    if (begin < 0 || peak < begin || peak >= begin + places.width) view.location.peak[r] = -1;
  }
  return view;
}

StripeProfile measure_view(const LoggedView& view,
                           const StripeOptions& logged,
                           const StripeOptions& options) {
  const StripeSignal signal(view.windows, options.channel);
  if (same_place(logged, options)) return measure_stripe(signal, view.location, options);
  return measure_stripe(signal, locate_stripe(signal, options), options);
}

}  // namespace facula
