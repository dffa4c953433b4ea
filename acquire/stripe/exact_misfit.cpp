// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/exact_misfit.hpp>
#include <facula/acquire/stripe/peak_shape.hpp>
#include <facula/acquire/stripe/signal_row.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace facula {

RowAbout rows_of(const StripeSignal& signal) {
  return [&signal](std::size_t r, int, int) { return signal.row(static_cast<int>(r)); };
}

RowAbout rows_of(ImageView8 frame, ImageView8 background, Channel channel) {
  return [frame,
          background,
          channel,
          values = std::vector<std::int16_t>(),
          clipped = std::vector<std::uint8_t>()](std::size_t r, int c, int reach) mutable {
    const int begin = std::clamp(c - reach, 0, frame.cols);
    const int end = std::clamp(c + reach + 1, begin, frame.cols);
    const auto part_of = [&](ImageView8 image) {
      image.data += static_cast<std::ptrdiff_t>(begin) * image.channels;
      image.cols = end - begin;
      return image;
    };
    values.resize(static_cast<std::size_t>(end - begin));
    clipped.resize(values.size());
    const ImageView8 lit = part_of(frame);
    const ImageView8 dark = background.empty() ? background : part_of(background);
    read_signal_row(lit, dark, static_cast<int>(r), channel, values.data());
    const std::uint8_t* pixels = lit.row(static_cast<int>(r));
    for (std::uint8_t& flag : clipped) {
      const std::uint8_t* next = pixels + lit.channels;
      flag = std::find(pixels, next, std::uint8_t{255}) != next ? 1 : 0;
      pixels = next;
    }
    return SignalRow{values.data(), clipped.data(), begin, end};
  };
}

ExactMisfit::ExactMisfit(RowAbout row_about, double sigma)
    : row_about_(std::move(row_about)), most_reach_(5 * sigma) {}

StripeCandidate ExactMisfit::of(const MeasuredRows& rows, std::size_t r) const {
  StripeCandidate found;
  found.position = rows.profile.position[r];
  found.width = rows.profile.width[r];
  if (!std::isfinite(found.position) || !std::isfinite(found.width)) return found;
  const int c = static_cast<int>(std::lround(found.position));
  const SignalRow row = row_about_(r, c, static_cast<int>(std::ceil(most_reach_)) + 1);
  if (row.holds(c)) measure_misfit(row, found, most_reach_);
  return found;
}

}  // namespace facula
