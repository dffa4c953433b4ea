// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/report/legend.hpp>
#include <facula/apps/report/number_format.hpp>
#include <facula/apps/report/text.hpp>
#include <facula/apps/report/view_panels.hpp>

#include <algorithm>
#include <cmath>

namespace facula {
namespace {

constexpr double kFilled = 0.92;  // share of a panel the box may fill [1]
constexpr int kGap = 10;          // between panels [px]
constexpr int kNameRow = 34;      // [px]
constexpr int kFootRow = 52;      // [px]

}  // namespace

ViewPanels fit_panels(const std::vector<ViewDirection>& views,
                      const std::vector<Eigen::AlignedBox3d>& seen,
                      int size) {
  require(views.size() == seen.size(), "every view needs its box");
  ViewPanels panels;
  panels.views = views;
  Eigen::Vector3d largest = Eigen::Vector3d::Constant(1e-9);
  for (std::size_t i = 0; i < views.size(); ++i) {
    largest = largest.cwiseMax(seen[i].sizes());
    panels.centers.emplace_back(views[i].rotation().transpose() * seen[i].center());
  }
  panels.pixels_per_metre = kFilled * size / largest.head<2>().maxCoeff();
  const double height = largest.y() * panels.pixels_per_metre + (1 - kFilled) * size;
  panels.rows = std::clamp(static_cast<int>(std::ceil(height)), size / 3, size);
  panels.cols = size;
  return panels;
}

Image8 join_panels(const ViewPanels& panels,
                   const std::vector<Image8>& pictures,
                   const std::string& remark) {
  require(pictures.size() == panels.views.size(),
          "there are ",
          pictures.size(),
          " pictures for ",
          panels.views.size(),
          " views");
  const Image8 row = beside(pictures, kGap);
  Image8 canvas = make_canvas(row.rows + kNameRow + kFootRow, row.cols);
  paste(canvas, row, 0, kNameRow);
  int x = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    draw_text(canvas, {x + 4.0, kNameRow / 2.0}, panels.views[i].name, {.size = 18});
    draw_box(canvas, {x, kNameRow, pictures[i].cols, pictures[i].rows}, kHairline);
    x += pictures[i].cols + kGap;
  }
  const double foot = canvas.rows - 16.0;
  draw_scale_bar(canvas, {8, foot}, panels.pixels_per_metre, panels.cols);
  draw_text(
      canvas, {canvas.cols - 8.0, foot - 8}, remark, {.size = 18, .align = TextAlign::kRight});
  return canvas;
}

std::string box_dimensions(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d sides = box.sizes();
  const LengthUnit unit = length_unit_for(sides.maxCoeff());
  std::string text;
  for (int k = 0; k < 3; ++k) {
    text += (k > 0 ? " × " : "") + format_significant(sides[k] * unit.per_metre, 4);
  }
  return text + " " + unit.name;
}

Image8 halved(const Image8& picture) {
  Image8 half = make_canvas(picture.rows / 2, picture.cols / 2);
  for (int row = 0; row < half.rows; ++row) {
    for (int k = 0; k < half.cols * 3; ++k) {
      const int left = k / 3 * 6 + k % 3;
      const std::uint8_t* upper = picture.row(2 * row) + left;
      const std::uint8_t* lower = picture.row(2 * row + 1) + left;
      const int sum = upper[0] + upper[3] + lower[0] + lower[3];
      half.row(row)[k] = static_cast<std::uint8_t>((sum + 2) / 4);
    }
  }
  return half;
}

}  // namespace facula
