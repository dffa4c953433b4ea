// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/triangulate/measured_frame.hpp>
#include <facula/acquire/triangulate/zero_line.hpp>

namespace facula {
namespace {

void check_size(const Image8& frame, const Capture& capture, std::size_t i) {
  const Camera& camera = capture.rig.camera;
  require(frame.cols == camera.width && frame.rows == camera.height,
          "frame ",
          i,
          ": expected ",
          camera.width,
          " x ",
          camera.height,
          " px as the rig's camera says, got ",
          frame.cols,
          " x ",
          frame.rows);
}

double time_of(const Capture& capture, std::size_t i) {
  return static_cast<double>(i) * capture.frame_interval;
}

void move_onto_bed(const Capture& capture, const StripeProfile& bed, MeasuredFrame& frame) {
  try {
    frame.bed_shift = measure_against_bed(*capture.zero_line, bed, frame.profile);
  } catch (const Error& error) {
    fail("frame ", frame.index, " against its zero line: ", error.what());
  }
}

}  // namespace

FrameImages read_images(const Capture& capture, const CaptureFrames& frames, std::size_t i) {
  FrameImages images;
  images.lit = frames.lit(i);
  check_size(images.lit, capture, i);
  images.dark = frames.dark(i);
  if (capture.zero_line) {
    images.bed = read_image(capture.zero_line->frames[i]);
    check_size(images.bed, capture, i);
  }
  return images;
}

MeasuredFrame measure_frame(const Capture& capture, const CaptureFrames& frames, std::size_t i) {
  const FrameImages images = read_images(capture, frames, i);
  MeasuredFrame frame{.index = i, .position = capture.positions[i], .time = time_of(capture, i)};
  frame.profile = detect_stripe(images.lit.view(), images.dark.view(), capture.stripe);
  if (capture.zero_line) {
    move_onto_bed(capture, detect_stripe(images.bed.view(), {}, capture.stripe), frame);
  }
  return frame;
}

LoggedFrame log_frame(const Capture& capture,
                      const CaptureFrames& frames,
                      std::size_t i,
                      int width) {
  const FrameImages images = read_images(capture, frames, i);
  LoggedFrame frame{.index = i, .position = capture.positions[i], .time = time_of(capture, i)};
  frame.views.push_back(log_view({images.lit.view(), images.dark.view()}, capture.stripe, width));
  if (capture.zero_line) {
    frame.views.push_back(log_view({images.bed.view(), {}}, capture.stripe, width));
  }
  return frame;
}

MeasuredFrame measure_logged(const LoggedFrame& logged_frame,
                             const StripeOptions& logged,
                             const Capture& capture) {
  MeasuredFrame frame{
      .index = logged_frame.index, .position = logged_frame.position, .time = logged_frame.time};
  frame.profile = measure_view(logged_frame.views[0], logged, capture.stripe);
  if (capture.zero_line) {
    move_onto_bed(capture, measure_view(logged_frame.views[1], logged, capture.stripe), frame);
  }
  return frame;
}

}  // namespace facula
