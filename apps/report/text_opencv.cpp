// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/apps/report/text.hpp>

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace facula {
namespace {

// OpenCV's stroke fonts look rough at the size of a picture's labels: text is drawn this many times
// larger and averaged down.
constexpr int kFiner = 4;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitalShare = 0.62;   // height of a capital over the line's height
constexpr double kCapitalPixels = 21.0;  // height of a capital of the font at scale 1 [px]

enum class Mark { kNone, kTail, kBar, kRing, kCross };

/// A sign the font can draw, with what is added to it.
struct Glyph {
  std::string text;
  Mark mark = Mark::kNone;
};

Glyph sign_of_unit(unsigned char lead, unsigned char trail) {
  if (lead == 0xC2 && trail == 0xB5) return {"u", Mark::kTail};   // µ
  if (lead == 0xC2 && trail == 0xB1) return {"+", Mark::kBar};    // ±
  if (lead == 0xC2 && trail == 0xB0) return {" ", Mark::kRing};   // °
  if (lead == 0xC3 && trail == 0x97) return {" ", Mark::kCross};  // ×
  return {"?", Mark::kNone};
}

std::vector<Glyph> glyphs_of(const std::string& text) {
  std::vector<Glyph> glyphs;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte >= 0x20 && byte < 0x7f) {
      glyphs.push_back({std::string(1, text[i]), Mark::kNone});
      continue;
    }
    const bool has_trail = byte >= 0xC2 && i + 1 < text.size();
    glyphs.push_back(has_trail ? sign_of_unit(byte, static_cast<unsigned char>(text[i + 1]))
                               : Glyph{"?", Mark::kNone});
    while (i + 1 < text.size() && (static_cast<unsigned char>(text[i + 1]) & 0xC0) == 0x80) ++i;
  }
  return glyphs;
}

/// Measures of a text in the finer raster.
struct Setting {
  double scale = 1;    // of the font
  int thickness = 1;   // of its strokes [px]
  double capital = 0;  // height of a capital [px]
};

Setting setting_of(double size) {
  const double capital = std::clamp(size, 6.0, 200.0) * kCapitalShare * kFiner;
  return {capital / kCapitalPixels, std::max(1, static_cast<int>(capital * 0.115)), capital};
}

double text_advance(const std::string& text, const Setting& setting) {
  // The size OpenCV returns holds the stroke's thickness once per call.
  return cv::getTextSize(text, kFont, setting.scale, 1, nullptr).width - 1.0;
}

std::string drawn_text(const std::vector<Glyph>& glyphs) {
  std::string text;
  for (const Glyph& glyph : glyphs) text += glyph.text;
  return text;
}

void draw_mark(cv::Mat& mask, const Glyph& glyph, const cv::Point2d& base, const Setting& setting) {
  const double width = text_advance(glyph.text, setting);
  const double unit = setting.capital;
  const auto at = [&](double along, double over) {
    return cv::Point(static_cast<int>(std::lround(base.x + along)),
                     static_cast<int>(std::lround(base.y - over)));
  };
  const auto line = [&](cv::Point from, cv::Point to) {
    cv::line(mask, from, to, cv::Scalar(255), setting.thickness, cv::LINE_AA);
  };
  if (glyph.mark == Mark::kTail) line(at(0.19 * width, 0.55 * unit), at(0.19 * width, -0.3 * unit));
  if (glyph.mark == Mark::kBar) line(at(0.15 * width, 0), at(0.85 * width, 0));
  if (glyph.mark == Mark::kRing) {
    cv::circle(mask,
               at(0.5 * width, 0.82 * unit),
               static_cast<int>(0.18 * unit),
               cv::Scalar(255),
               setting.thickness,
               cv::LINE_AA);
  }
  if (glyph.mark == Mark::kCross) {
    const double arm = 0.22 * unit;
    const double middle = 0.36 * unit;
    line(at(width / 2 - arm, middle - arm), at(width / 2 + arm, middle + arm));
    line(at(width / 2 - arm, middle + arm), at(width / 2 + arm, middle - arm));
  }
}

/// The text's coverage [0..255], its margin around the capitals `capital` high and wide.
cv::Mat text_mask(const std::vector<Glyph>& glyphs, const Setting& setting) {
  const std::string text = drawn_text(glyphs);
  const double width = text_advance(text, setting);
  const auto full = [](double finer) {
    return static_cast<int>(std::ceil(finer / kFiner)) * kFiner;
  };
  cv::Mat mask =
      cv::Mat::zeros(full(3 * setting.capital), full(width + 2 * setting.capital), CV_8UC1);
  const cv::Point2d base(setting.capital, 2 * setting.capital);
  cv::putText(mask,
              text,
              cv::Point(base),
              kFont,
              setting.scale,
              cv::Scalar(255),
              setting.thickness,
              cv::LINE_AA);
  std::string before;
  for (const Glyph& glyph : glyphs) {
    draw_mark(mask, glyph, {base.x + text_advance(before, setting), base.y}, setting);
    before += glyph.text;
  }
  cv::Mat small;
  cv::resize(mask, small, mask.size() / kFiner, 0, 0, cv::INTER_AREA);
  return small;
}

}  // namespace

double text_width(const std::string& text, double size) {
  return text_advance(drawn_text(glyphs_of(text)), setting_of(size)) / kFiner;
}

void draw_text(Image8& canvas,
               const Eigen::Vector2d& anchor,
               const std::string& text,
               const TextStyle& style) {
  if (text.empty() || !anchor.allFinite() || anchor.cwiseAbs().maxCoeff() > 1e6) return;
  const Setting setting = setting_of(style.size);
  const cv::Mat mask = text_mask(glyphs_of(text), setting);
  const double width = text_width(text, style.size);
  double left = anchor.x();
  if (style.align == TextAlign::kCenter) left -= width / 2;
  if (style.align == TextAlign::kRight) left -= width;
  const double capital = setting.capital / kFiner;
  const int x0 = static_cast<int>(std::lround(left - capital));
  const int y0 = static_cast<int>(std::lround(anchor.y() - 1.5 * capital));
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      blend_pixel(canvas, x0 + x, y0 + y, style.color, mask.at<std::uint8_t>(y, x) / 255.0);
    }
  }
}

}  // namespace facula
