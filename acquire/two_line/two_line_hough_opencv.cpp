// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/two_line/two_line_segments.hpp>

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace facula {
namespace {

cv::Mat grey_of(ImageView8 image) {
  cv::Mat whole(image.rows,
                image.cols,
                image.channels == 3 ? CV_8UC3 : CV_8UC1,
                const_cast<std::uint8_t*>(image.data),
                static_cast<std::size_t>(image.stride));
  if (image.channels == 1) return whole;
  cv::Mat grey;
  cv::cvtColor(whole, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

cv::Mat undistorted(const cv::Mat& grey, const Camera& c) {
  const cv::Mat matrix = (cv::Mat_<double>(3, 3) << c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  const cv::Mat distortion = (cv::Mat_<double>(1, 5) << c.k1, c.k2, c.p1, c.p2, c.k3);
  cv::Mat result;
  cv::undistort(grey, result, matrix, distortion);
  return result;
}

/// A Hough segment where it crosses the middle column, and how long it is.
struct Crossing {
  double row = 0;     ///< [px]
  double length = 0;  ///< [px]
};

/// The grey value below which `share` of the pixels lie, from their histogram [DN].
int quantile(const std::vector<int>& histogram, int pixels, double share) {
  int below = 0;
  for (int value = 0; value < 256; ++value) {
    below += histogram[static_cast<std::size_t>(value)];
    if (below > share * pixels) return value;
  }
  return 255;
}

/// Half way up from the middle grey value to that of the brightest half per cent, which a line of
/// light fills several times; 255, which nothing exceeds, where that does not stand out.
double automatic_threshold(const cv::Mat& part) {
  constexpr double kBrightest = 0.995;
  constexpr double kLeastHeight = 8;  // [DN]
  constexpr double kLeastRatio = 4;   // of the brightest over the scatter; noise has 2.6
  std::vector<int> histogram(256, 0);
  for (int v = 0; v < part.rows; ++v) {
    for (int u = 0; u < part.cols; ++u) ++histogram[part.at<std::uint8_t>(v, u)];
  }
  const int pixels = part.rows * part.cols;
  const int background = quantile(histogram, pixels, 0.5);
  const int scatter = background - quantile(histogram, pixels, 0.159);
  const int height = quantile(histogram, pixels, kBrightest) - background;
  if (height < std::max(kLeastHeight, kLeastRatio * scatter)) return 255;
  return background + 0.5 * height;
}

/// White where there is light. The lines may differ in brightness, so each side of the camera's
/// axis has a threshold of its own where none is given.
cv::Mat bright_part(const cv::Mat& segment, int middle, double threshold) {
  cv::Mat bright(segment.size(), CV_8UC1);
  for (const cv::Range& side : {cv::Range(0, middle), cv::Range(middle, segment.rows)}) {
    if (side.empty()) continue;
    const cv::Mat part = segment.rowRange(side);
    cv::Mat white = bright.rowRange(side);
    const double level = threshold > 0 ? threshold : automatic_threshold(part);
    cv::threshold(part, white, level, 255, cv::THRESH_BINARY);
  }
  return bright;
}

std::vector<Crossing> crossings_of(const cv::Mat& segment,
                                   int middle,
                                   const TwoLineOptions& options) {
  const cv::Mat bright = bright_part(segment, middle, options.threshold);
  cv::Mat edges;
  cv::Canny(bright, edges, 50, 150);
  std::vector<cv::Vec4i> lines;
  const int width = segment.cols;
  cv::HoughLinesP(edges, lines, 1, CV_PI / 180, width / 3, width / 3.0, width / 5.0);
  std::vector<Crossing> crossings;
  for (const cv::Vec4i& l : lines) {
    const double dx = l[2] - l[0];
    const double dy = l[3] - l[1];
    if (std::abs(dx) <= std::abs(dy)) continue;  // the lines of light lie level
    const double row = l[1] + dy / dx * (0.5 * (width - 1) - l[0]);
    crossings.push_back({row, std::hypot(dx, dy)});
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.row < b.row;
  });
  return crossings;
}

/// Segments that stand for one line of light, averaged by their lengths.
struct Group {
  double row = 0;      ///< [px]
  double length = 0;   ///< of all its segments [px]
  double squares = 0;  ///< length times squared distance from row
  int count = 0;
};

std::vector<Group> grouped(const std::vector<Crossing>& crossings, double merge_distance) {
  std::vector<Group> groups;
  double last_row = 0;
  for (const Crossing& c : crossings) {
    if (groups.empty() || c.row - last_row > merge_distance) groups.emplace_back();
    Group& g = groups.back();
    const double moved = c.row - g.row;
    g.length += c.length;
    g.row += moved * c.length / g.length;
    g.squares += c.length * moved * (c.row - g.row);
    ++g.count;
    last_row = c.row;
  }
  return groups;
}

/// The longest group on one side of the camera's axis.
const Group* longest(const std::vector<Group>& groups, double middle, bool above) {
  const Group* best = nullptr;
  for (const Group& g : groups) {
    if ((g.row < middle) != above) continue;
    if (best == nullptr || g.length > best->length) best = &g;
  }
  return best;
}

double sigma_of(const Group& g) {
  const double rounding = 1.0 / 12;
  return std::sqrt((g.squares / g.length + rounding) / g.count);
}

}  // namespace

void find_by_hough(ImageView8 frame,
                   ImageView8 background,
                   const Rig& rig,
                   const TwoLineOptions& options,
                   std::vector<TwoLineReading>& readings) {
  require(!frame.empty(), "expected a frame with pixels");
  cv::Mat grey = grey_of(frame);
  if (!background.empty()) {
    require(background.rows == frame.rows && background.cols == frame.cols,
            "expected a background of the frame's size");
    cv::Mat difference;
    cv::subtract(grey, grey_of(background), difference);
    grey = difference;
  }
  const cv::Mat picture = undistorted(grey, rig.camera);
  const int middle = std::clamp(static_cast<int>(std::lround(rig.camera.cy)), 0, picture.rows);
  for (TwoLineReading& reading : readings) {
    const int first =
        static_cast<int>(std::lround(reading.centre_px - 0.5 * (options.segment_width - 1)));
    const int last = std::min(first + options.segment_width, picture.cols);
    const cv::Mat segment = picture.colRange(std::max(0, first), last).clone();
    const auto groups = grouped(crossings_of(segment, middle, options), options.merge_distance);
    const Group* upper = longest(groups, rig.camera.cy, true);
    const Group* lower = longest(groups, rig.camera.cy, false);
    if (upper == nullptr || lower == nullptr) {
      reading.failure = upper != nullptr   ? "no line below the camera's axis"
                        : lower != nullptr ? "no line above the camera's axis"
                                           : "no line";
      continue;
    }
    const auto ideal_row = [&](double row) {
      const Camera& c = rig.camera;
      return ideal_pixel({(reading.centre_px - c.cx) / c.fx, (row - c.cy) / c.fy}, rig).y();
    };
    reading.upper_px = ideal_row(upper->row);
    reading.lower_px = ideal_row(lower->row);
    reading.separation_sigma_px = std::hypot(sigma_of(*upper), sigma_of(*lower));
  }
}

}  // namespace facula
