// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/report/drawing.hpp>

#include <string>
#include <vector>

namespace facula {

/// A patch of colour and what it stands for; without `color_shown` a plain remark.
struct LegendEntry {
  Color color = kInk;
  std::string text;
  bool color_shown = true;
};

/// The entries as a strip `width` px wide, in as many lines as they need.
Image8 legend(const std::vector<LegendEntry>& entries, int width);

/// A labelled bar of a round length, a tenth to a quarter of `width` px, its left end at (x, y).
/// `pixels_per_metre` must be above 0.
void draw_scale_bar(Image8& canvas,
                    const Eigen::Vector2d& left_end,
                    double pixels_per_metre,
                    int width);

/// A picture that says why there is nothing to see.
Image8 empty_picture(const std::string& sentence);

}  // namespace facula
