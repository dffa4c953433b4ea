// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/core/point_cloud.hpp>

#include <vector>

#include <Eigen/Core>

namespace facula {

inline constexpr Color kPaper{255, 255, 255};
inline constexpr Color kInk{38, 42, 50};
inline constexpr Color kFaintInk{120, 126, 136};
inline constexpr Color kHairline{205, 209, 215};

/// A rectangle of pixels; x to the right, y down.
struct PixelBox {
  int x = 0;       ///< left column [px]
  int y = 0;       ///< top row [px]
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
};

struct Stroke {
  Color color = kInk;
  double width = 1.0;  ///< [px]
};

// A canvas is an Image8 of 3 channels (blue, green, red). Points are (x, y) [px], (0, 0) the centre
// of the top left pixel. What lies outside the canvas is cut off; points that are not finite draw
// nothing.

/// A canvas of one colour. Throws Error unless both sides are 1 to 20000 px.
Image8 make_canvas(int rows, int cols, Color background = kPaper);

void set_pixel(Image8& canvas, int x, int y, Color color);

/// Lays `color` over the pixel; coverage in [0, 1].
void blend_pixel(Image8& canvas, int x, int y, Color color, double coverage);

Color pixel_color(const Image8& canvas, int x, int y);

void fill_box(Image8& canvas, const PixelBox& box, Color color);

/// A frame of 1 px just inside the box.
void draw_box(Image8& canvas, const PixelBox& box, Color color);

/// A line with round ends, anti-aliased.
void draw_line(Image8& canvas,
               const Eigen::Vector2d& from,
               const Eigen::Vector2d& to,
               const Stroke& stroke = {});

/// A filled disc, anti-aliased.
void draw_disc(Image8& canvas, const Eigen::Vector2d& center, double radius, Color color);

/// Copies a picture onto the canvas, its top left pixel at (x, y).
void paste(Image8& canvas, const Image8& picture, int x, int y);

/// Pictures side by side (top edges in line) or one below the other (left edges in line), `gap` px
/// apart, on paper. At least one picture.
Image8 beside(const std::vector<Image8>& pictures, int gap = 0);
Image8 below(const std::vector<Image8>& pictures, int gap = 0);

}  // namespace facula
