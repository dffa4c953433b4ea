// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/legend.hpp>
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/text.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr int kLine = 30;  // height of a line [px]
constexpr int kPatch = 16;
constexpr int kGap = 28;  // between entries [px]
constexpr double kTextSize = 18;

int entry_width(const LegendEntry& entry) {
  const int patch = entry.color_shown ? kPatch + 8 : 0;
  return patch + static_cast<int>(std::ceil(text_width(entry.text, kTextSize)));
}

/// Upper left corners of the entries, filled line by line.
std::vector<PixelBox> placed(const std::vector<LegendEntry>& entries, int width) {
  std::vector<PixelBox> boxes;
  int x = 4;
  int y = 0;
  for (const LegendEntry& entry : entries) {
    const int needed = entry_width(entry);
    if (x > 4 && x + needed > width) {
      x = 4;
      y += kLine;
    }
    boxes.push_back({x, y, needed, kLine});
    x += needed + kGap;
  }
  return boxes;
}

}  // namespace

Image8 legend(const std::vector<LegendEntry>& entries, int width) {
  const std::vector<PixelBox> boxes = placed(entries, width);
  int widest = width;
  for (const PixelBox& box : boxes) widest = std::max(widest, box.x + box.width + 4);
  Image8 canvas = make_canvas(boxes.empty() ? 1 : boxes.back().y + kLine + 6, widest);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double middle = boxes[i].y + kLine / 2.0;
    int x = boxes[i].x;
    if (entries[i].color_shown) {
      const PixelBox patch{x, static_cast<int>(middle) - kPatch / 2, kPatch, kPatch};
      fill_box(canvas, patch, entries[i].color);
      draw_box(canvas, patch, kFaintInk);
      x += kPatch + 8;
    }
    draw_text(canvas, {static_cast<double>(x), middle}, entries[i].text, {.size = kTextSize});
  }
  return canvas;
}

void draw_scale_bar(Image8& canvas,
                    const Eigen::Vector2d& left_end,
                    double pixels_per_metre,
                    int width) {
  const std::vector<double> ticks = round_ticks(0, 0.3 * width / pixels_per_metre, 3);
  if (ticks.size() < 2) return;
  const double length = ticks[1];
  const LengthUnit unit = length_unit_for(length);
  const Eigen::Vector2d right_end = left_end + Eigen::Vector2d(length * pixels_per_metre, 0);
  const Eigen::Vector2d end_mark(0, 5);
  const Stroke stroke{kInk, 2};
  draw_line(canvas, left_end, right_end, stroke);
  draw_line(canvas, left_end - end_mark, left_end + end_mark, stroke);
  draw_line(canvas, right_end - end_mark, right_end + end_mark, stroke);
  const std::string text = format_significant(length * unit.per_metre, 1) + " " + unit.name;
  // Over the bar's middle, but where that would cut it off: a bar may be shorter than its label.
  const double half = text_width(text, kTextSize) / 2 + 2;
  Eigen::Vector2d middle = (left_end + right_end) / 2 - Eigen::Vector2d(0, 16);
  middle.x() = std::max(half, std::min(middle.x(), canvas.cols - half));
  draw_text(canvas, middle, text, {.size = kTextSize, .align = TextAlign::kCenter});
}

Image8 empty_picture(const std::string& sentence) {
  constexpr int kRows = 160;
  const int cols = std::clamp(static_cast<int>(text_width(sentence, 20)) + 80, 480, 1400);
  Image8 canvas = make_canvas(kRows, cols, {246, 247, 249});
  draw_box(canvas, {0, 0, cols, kRows}, kHairline);
  draw_text(canvas,
            {cols / 2.0, kRows / 2.0},
            sentence,
            {.size = 20, .color = kFaintInk, .align = TextAlign::kCenter});
  return canvas;
}

}  // namespace facula
