// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/legend.hpp>
#include <facula/apps/report/stripe_over_frame.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace facula {
namespace {

constexpr Color kStripeColor{0, 229, 255};
constexpr Color kSaturatedColor{255, 64, 220};
constexpr Color kMissingColor{255, 179, 48};
constexpr Color kGutterColor{232, 234, 238};
constexpr int kGutter = 8;          // strip beside the frame for rows that were not seen [px]
constexpr double kLargestJump = 6;  // farther neighbours are not joined by a line [frame px]

/// How frame pixels become picture pixels.
struct Zoom {
  int scale = 1;  // picture pixels per frame pixel
  int step = 1;   // frame pixels per picture pixel

  double of(double frame_px) const { return (frame_px + 0.5) * scale / step - 0.5; }
};

Zoom zoom_for(const ImageView8& frame) {
  const int longest = std::max(frame.rows, frame.cols);
  return {std::clamp(900 / longest, 1, 16), (longest + 1599) / 1600};
}

Color frame_color(const ImageView8& frame, int row, int col) {
  const std::uint8_t* pixel = frame.row(row) + static_cast<std::ptrdiff_t>(col) * frame.channels;
  if (frame.channels == 1) return {pixel[0], pixel[0], pixel[0]};
  return {pixel[2], pixel[1], pixel[0]};
}

/// The brightest pixel of the block: a line 1 px wide must not vanish when the frame is reduced.
Color brightest(const ImageView8& frame, int row, int col, int step) {
  Color best = frame_color(frame, row, col);
  for (int r = row; r < std::min(row + step, frame.rows); ++r) {
    for (int c = col; c < std::min(col + step, frame.cols); ++c) {
      const Color color = frame_color(frame, r, c);
      if (color[0] + color[1] + color[2] > best[0] + best[1] + best[2]) best = color;
    }
  }
  return best;
}

void paint_frame(Image8& canvas, const ImageView8& frame, const Zoom& zoom) {
  for (int row = 0; row < frame.rows; row += zoom.step) {
    for (int col = 0; col < frame.cols; col += zoom.step) {
      const PixelBox box{kGutter + col / zoom.step * zoom.scale,
                         kGutter + row / zoom.step * zoom.scale,
                         zoom.scale,
                         zoom.scale};
      fill_box(canvas, box, brightest(frame, row, col, zoom.step));
    }
  }
}

Eigen::Vector2d stripe_pixel(const StripeProfile& profile,
                             std::size_t line,
                             StripeDirection direction,
                             const Zoom& zoom) {
  const double along = kGutter + zoom.of(static_cast<double>(line));
  const double across = kGutter + zoom.of(profile.position[line]);
  if (direction == StripeDirection::kPerColumn) return {along, across};
  return {across, along};
}

void draw_stripe(Image8& canvas,
                 const StripeProfile& profile,
                 StripeDirection direction,
                 const Zoom& zoom) {
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (profile.seen[i] == 0) continue;
    const Eigen::Vector2d here = stripe_pixel(profile, i, direction, zoom);
    const Color color = profile.saturated[i] != 0 ? kSaturatedColor : kStripeColor;
    const bool joined = i > 0 && profile.seen[i - 1] != 0 &&
                        std::abs(profile.position[i] - profile.position[i - 1]) <= kLargestJump;
    const Eigen::Vector2d from = joined ? stripe_pixel(profile, i - 1, direction, zoom) : here;
    draw_line(canvas, from, here, {color, 1.8});
  }
}

void mark_missing(Image8& canvas,
                  const StripeProfile& profile,
                  StripeDirection direction,
                  const Zoom& zoom) {
  for (std::size_t i = 0; i < profile.size(); ++i) {
    if (profile.seen[i] != 0) continue;
    const int begin = kGutter + static_cast<int>(i) / zoom.step * zoom.scale;
    PixelBox box{2, begin, kGutter - 4, zoom.scale};
    if (direction == StripeDirection::kPerColumn) box = {begin, 2, zoom.scale, kGutter - 4};
    fill_box(canvas, box, kMissingColor);
  }
}

void check_inputs(const ImageView8& frame, const StripeProfile& profile, std::size_t lines) {
  require(frame.channels == 1 || frame.channels == 3,
          "a frame has 1 or 3 channels, not ",
          frame.channels);
  const bool consistent =
      profile.position.size() == profile.size() && profile.saturated.size() == profile.size();
  require(profile.size() == lines && consistent,
          "the stripe has ",
          profile.size(),
          " lines, the frame ",
          lines,
          ": draw a stripe over the frame it was found in");
}

Image8 stripe_legend(const StripeProfile& profile, StripeDirection direction, int width) {
  std::size_t seen = 0;
  std::size_t saturated = 0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    seen += profile.seen[i] != 0 ? 1 : 0;
    saturated += profile.seen[i] != 0 && profile.saturated[i] != 0 ? 1 : 0;
  }
  const std::string lines = direction == StripeDirection::kPerRow ? " rows" : " columns";
  std::vector<LegendEntry> entries{
      {kStripeColor,
       "stripe, " + std::to_string(seen) + " of " + std::to_string(profile.size()) + lines},
      {kMissingColor, "not seen, " + std::to_string(profile.size() - seen) + lines}};
  if (saturated > 0) {
    entries.push_back({kSaturatedColor, "saturated, " + std::to_string(saturated) + lines});
  }
  return legend(entries, width);
}

}  // namespace

Image8 stripe_over_frame(ImageView8 frame,
                         const StripeProfile& profile,
                         StripeDirection direction) {
  if (frame.empty()) return empty_picture("The frame is empty.");
  const int lines = direction == StripeDirection::kPerRow ? frame.rows : frame.cols;
  check_inputs(frame, profile, static_cast<std::size_t>(lines));
  const Zoom zoom = zoom_for(frame);
  const int height = (frame.rows + zoom.step - 1) / zoom.step * zoom.scale;
  const int width = (frame.cols + zoom.step - 1) / zoom.step * zoom.scale;
  Image8 canvas = make_canvas(height + kGutter, width + kGutter, kGutterColor);
  paint_frame(canvas, frame, zoom);
  draw_stripe(canvas, profile, direction, zoom);
  mark_missing(canvas, profile, direction, zoom);
  return below({canvas, stripe_legend(profile, direction, canvas.cols)}, 4);
}

}  // namespace facula
