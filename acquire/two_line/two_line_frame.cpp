// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/two_line/two_line_frame.hpp>
#include <facula/acquire/two_line/two_line_segments.hpp>

#include <cmath>

namespace facula {
namespace {

double index_of(const Rig& rig) {
  return rig.two_line ? rig.two_line->medium_index : 1;
}

std::vector<TwoLineReading> empty_readings(const Rig& rig, const TwoLineOptions& options) {
  const int width = options.segments * options.segment_width;
  require(width <= rig.camera.width,
          "expected segments within the picture's ",
          rig.camera.width,
          " px, got ",
          options.segments,
          " of ",
          options.segment_width,
          " px");
  std::vector<TwoLineReading> readings;
  const double first = 0.5 * (rig.camera.width - 1) - 0.5 * width + 0.5 * options.segment_width;
  for (int i = 0; i < options.segments; ++i) {
    TwoLineReading reading;
    reading.centre_px = first + i * options.segment_width;
    reading.angle = std::atan2(reading.centre_px - rig.camera.cx, rig.camera.fx * index_of(rig));
    readings.push_back(reading);
  }
  return readings;
}

/// (4) and (11).
void range(TwoLineReading& reading, const Rig& rig) {
  const TwoLineHead head = rig.two_line.value_or(TwoLineHead{});
  reading.depth = head.depth(separation_of(reading, rig));
  if (!reading.depth) {
    reading.failure = "the lines are no farther apart than at infinity";
    return;
  }
  reading.sigma = head.depth_error(
      *reading.depth, reading.separation_sigma_px / (rig.camera.fy * head.medium_index));
}

}  // namespace

void TwoLineOptions::check() const {
  require(segments >= 1 && segments <= 10000, "expected 1 or more segments, got ", segments);
  require(segment_width >= 8 && segment_width <= 100000,
          "expected segments of 8 px or more, got ",
          segment_width);
  require(
      threshold >= 0 && threshold <= 255, "expected a threshold of 0 to 255 DN, got ", threshold);
  require(merge_distance > 0 && std::isfinite(merge_distance),
          "expected a merge distance above 0 px, got ",
          merge_distance);
  stripe.check();
}

Eigen::Vector2d ideal_pixel(const Eigen::Vector2d& normalized, const Rig& rig) {
  const Camera& c = rig.camera;
  const Eigen::Vector2d x = rig.two_line.value_or(TwoLineHead{}).in_medium(normalized);
  return {index_of(rig) * c.fx * x.x() + c.cx, index_of(rig) * c.fy * x.y() + c.cy};
}

double separation_of(const TwoLineReading& reading, const Rig& rig) {
  return (reading.lower_px - reading.upper_px) / (rig.camera.fy * index_of(rig));
}

std::vector<TwoLineReading> read_two_lines(ImageView8 frame,
                                           ImageView8 background,
                                           const Rig& rig,
                                           const TwoLineOptions& options) {
  options.check();
  require(rig.two_line.has_value(),
          "rig '",
          rig.name,
          "' has no [two_line] section; calibrate one with 'facula calibrate two-line'");
  require(frame.cols == rig.camera.width && frame.rows == rig.camera.height,
          "expected a frame of ",
          rig.camera.width,
          " x ",
          rig.camera.height,
          " px as the rig's camera says, got ",
          frame.cols,
          " x ",
          frame.rows);
  require(frame.rows >= 2, "expected a frame of 2 rows or more, one per line, got ", frame.rows);
  std::vector<TwoLineReading> readings = empty_readings(rig, options);
  if (options.method == TwoLineMethod::kHough) {
    find_by_hough(frame, background, rig, options, readings);
  } else {
    find_by_stripes(frame, background, rig, options, readings);
  }
  for (TwoLineReading& reading : readings) {
    if (reading.failure.empty()) range(reading, rig);
  }
  return readings;
}

}  // namespace facula
