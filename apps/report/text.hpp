// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/report/drawing.hpp>

#include <string>

#include <Eigen/Core>

namespace facula {

enum class TextAlign { kLeft, kCenter, kRight };

struct TextStyle {
  double size = 20;  ///< height of a line of text [px], 6 to 200
  Color color = kInk;
  TextAlign align = TextAlign::kLeft;
};

/// Writes one line of text; `anchor` is the left end, centre or right end (see align) at half the
/// height of a capital letter. Text is ASCII and the signs of units: µ ± × °; other signs are shown
/// as '?'.
void draw_text(Image8& canvas,
               const Eigen::Vector2d& anchor,
               const std::string& text,
               const TextStyle& style = {});

/// Width of the text as draw_text() writes it [px].
double text_width(const std::string& text, double size);

}  // namespace facula
