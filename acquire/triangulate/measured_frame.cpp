// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/bracket.hpp>
#include <facula/acquire/stripe/stripe_choice.hpp>
#include <facula/acquire/triangulate/measured_frame.hpp>
#include <facula/acquire/triangulate/zero_line.hpp>

#include <utility>
#include <vector>

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

StripeView view_of(const CapturedFrame& scene, const ColumnGate& gate) {
  return {scene.lit.view(), scene.dark.view(), &gate, scene.moving.view()};
}

/// Merges the other exposures into a frame that was measured from the first.
void merge_exposures(const Capture& capture,
                     const CaptureFrames& frames,
                     const ColumnGate& gate,
                     MeasuredFrame& frame) {
  std::vector<ExposedProfile> bracket = {{std::move(frame.profile), capture.exposures[0]}};
  for (std::size_t e = 1; e < frames.exposures(); ++e) {
    const CapturedFrame scene = frames.read(frame.index, e);
    check_size(scene.lit, capture, frame.index);
    bracket.push_back({detect_stripe(view_of(scene, gate), capture.stripe), capture.exposures[e]});
  }
  frame.profile = merge_bracket(bracket);
}

}  // namespace

FrameImages read_images(const Capture& capture, const CaptureFrames& frames, std::size_t i) {
  FrameImages images;
  images.scene = frames.read(i);
  check_size(images.scene.lit, capture, i);
  if (capture.zero_line) {
    images.bed = read_image(capture.zero_line->frames[i]);
    check_size(images.bed, capture, i);
  }
  return images;
}

MeasuredFrame measure_frame(const Capture& capture,
                            const CaptureFrames& frames,
                            const ColumnGate& gate,
                            std::size_t i) {
  MeasuredFrame frame{.index = i, .position = capture.positions[i], .time = time_of(capture, i)};
  const FrameImages images = read_images(capture, frames, i);
  frame.profile = detect_stripe(view_of(images.scene, gate), capture.stripe);
  if (frames.exposures() > 1) merge_exposures(capture, frames, gate, frame);
  if (capture.zero_line) {
    move_onto_bed(capture, detect_stripe(images.bed.view(), {}, capture.stripe), frame);
  }
  return frame;
}

LoggedFrame log_frame(const Capture& capture,
                      const CaptureFrames& frames,
                      const ColumnGate& gate,
                      std::size_t i,
                      int width) {
  const FrameImages images = read_images(capture, frames, i);
  LoggedFrame frame{.index = i, .position = capture.positions[i], .time = time_of(capture, i)};
  frame.views.push_back(log_view(view_of(images.scene, gate), capture.stripe, width));
  for (std::size_t e = 1; e < frames.exposures(); ++e) {
    const CapturedFrame scene = frames.read(i, e);
    check_size(scene.lit, capture, i);
    frame.views.push_back(log_view(view_of(scene, gate), capture.stripe, width));
  }
  if (capture.zero_line) {
    frame.views.push_back(log_view({images.bed.view()}, capture.stripe, width));
  }
  return frame;
}

MeasuredFrame measure_logged(const LoggedFrame& logged_frame,
                             const StripeOptions& logged,
                             const Capture& capture) {
  MeasuredFrame frame{
      .index = logged_frame.index, .position = logged_frame.position, .time = logged_frame.time};
  const auto profile = [&](std::size_t view) {
    return measure_view(logged_frame.views[view], logged, capture.stripe);
  };
  frame.profile = profile(0);
  const std::size_t exposures = capture.exposures_per_position();
  if (exposures > 1) {
    std::vector<ExposedProfile> bracket = {{std::move(frame.profile), capture.exposures[0]}};
    for (std::size_t e = 1; e < exposures; ++e)
      bracket.push_back({profile(e), capture.exposures[e]});
    frame.profile = merge_bracket(bracket);
  }
  if (capture.zero_line) move_onto_bed(capture, profile(exposures), frame);
  return frame;
}

}  // namespace facula
