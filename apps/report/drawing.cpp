// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/drawing.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr int kMostPixels = 20000;

bool inside(const Image8& canvas, int x, int y) {
  return x >= 0 && y >= 0 && x < canvas.cols && y < canvas.rows;
}

/// Pixels that anything within `reach` of the box from `low` to `high` can touch, cut to the
/// canvas.
PixelBox touched(const Image8& canvas,
                 const Eigen::Vector2d& low,
                 const Eigen::Vector2d& high,
                 double reach) {
  const auto limited = [](double value, int most) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(most)));
  };
  PixelBox box;
  box.x = limited(std::floor(low.x() - reach), canvas.cols);
  box.y = limited(std::floor(low.y() - reach), canvas.rows);
  box.width = limited(std::ceil(high.x() + reach) + 1, canvas.cols) - box.x;
  box.height = limited(std::ceil(high.y() + reach) + 1, canvas.rows) - box.y;
  return box;
}

double distance_to_segment(const Eigen::Vector2d& p,
                           const Eigen::Vector2d& from,
                           const Eigen::Vector2d& to) {
  const Eigen::Vector2d along = to - from;
  const double length2 = along.squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - from).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - from - share * along).norm();
}

}  // namespace

Image8 make_canvas(int rows, int cols, Color background) {
  require(rows >= 1 && cols >= 1 && rows <= kMostPixels && cols <= kMostPixels,
          "a picture needs 1 to ",
          kMostPixels,
          " px along both sides, not ",
          cols,
          " x ",
          rows);
  Image8 canvas(rows, cols, 3);
  fill_box(canvas, {0, 0, cols, rows}, background);
  return canvas;
}

void set_pixel(Image8& canvas, int x, int y, Color color) {
  if (!inside(canvas, x, y)) return;
  std::uint8_t* pixel = canvas.row(y) + static_cast<std::ptrdiff_t>(x) * 3;
  pixel[0] = color[2];
  pixel[1] = color[1];
  pixel[2] = color[0];
}

Color pixel_color(const Image8& canvas, int x, int y) {
  require(inside(canvas, x, y), "there is no pixel (", x, ", ", y, ") in the picture");
  const std::uint8_t* pixel = canvas.row(y) + static_cast<std::ptrdiff_t>(x) * 3;
  return {pixel[2], pixel[1], pixel[0]};
}

void blend_pixel(Image8& canvas, int x, int y, Color color, double coverage) {
  if (!inside(canvas, x, y) || !(coverage > 0)) return;
  const double share = std::min(coverage, 1.0);
  const Color below_it = pixel_color(canvas, x, y);
  for (std::size_t k = 0; k < 3; ++k) {
    color[k] = static_cast<std::uint8_t>(std::lround(share * color[k] + (1 - share) * below_it[k]));
  }
  set_pixel(canvas, x, y, color);
}

void fill_box(Image8& canvas, const PixelBox& box, Color color) {
  const int x_end = std::min(box.x + box.width, canvas.cols);
  const int y_end = std::min(box.y + box.height, canvas.rows);
  for (int y = std::max(box.y, 0); y < y_end; ++y) {
    for (int x = std::max(box.x, 0); x < x_end; ++x) set_pixel(canvas, x, y, color);
  }
}

void draw_box(Image8& canvas, const PixelBox& box, Color color) {
  fill_box(canvas, {box.x, box.y, box.width, 1}, color);
  fill_box(canvas, {box.x, box.y + box.height - 1, box.width, 1}, color);
  fill_box(canvas, {box.x, box.y, 1, box.height}, color);
  fill_box(canvas, {box.x + box.width - 1, box.y, 1, box.height}, color);
}

void draw_line(Image8& canvas,
               const Eigen::Vector2d& from,
               const Eigen::Vector2d& to,
               const Stroke& stroke) {
  if (!from.allFinite() || !to.allFinite()) return;
  const double reach = stroke.width / 2 + 0.5;
  const PixelBox box = touched(canvas, from.cwiseMin(to), from.cwiseMax(to), reach);
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      const double distance = distance_to_segment({x, y}, from, to);
      blend_pixel(canvas, x, y, stroke.color, std::min(reach - distance, stroke.width));
    }
  }
}

void draw_disc(Image8& canvas, const Eigen::Vector2d& center, double radius, Color color) {
  if (!center.allFinite()) return;
  const PixelBox box = touched(canvas, center, center, radius + 0.5);
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      const double distance = (Eigen::Vector2d(x, y) - center).norm();
      blend_pixel(canvas, x, y, color, radius + 0.5 - distance);
    }
  }
}

void paste(Image8& canvas, const Image8& picture, int x, int y) {
  for (int row = 0; row < picture.rows; ++row) {
    for (int col = 0; col < picture.cols; ++col) {
      set_pixel(canvas, x + col, y + row, pixel_color(picture, col, row));
    }
  }
}

Image8 beside(const std::vector<Image8>& pictures, int gap) {
  require(!pictures.empty(), "no picture to put beside another");
  int cols = -gap;
  int rows = 1;
  for (const Image8& picture : pictures) {
    cols += picture.cols + gap;
    rows = std::max(rows, picture.rows);
  }
  Image8 canvas = make_canvas(rows, cols);
  int x = 0;
  for (const Image8& picture : pictures) {
    paste(canvas, picture, x, 0);
    x += picture.cols + gap;
  }
  return canvas;
}

Image8 below(const std::vector<Image8>& pictures, int gap) {
  require(!pictures.empty(), "no picture to put below another");
  int cols = 1;
  int rows = -gap;
  for (const Image8& picture : pictures) {
    cols = std::max(cols, picture.cols);
    rows += picture.rows + gap;
  }
  Image8 canvas = make_canvas(rows, cols);
  int y = 0;
  for (const Image8& picture : pictures) {
    paste(canvas, picture, 0, y);
    y += picture.rows + gap;
  }
  return canvas;
}

}  // namespace facula
