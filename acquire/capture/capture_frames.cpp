// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/error.hpp>

namespace facula {

CaptureFrames::CaptureFrames(const Capture& capture)
    : frames_(open_frames(capture.frames)), alternation_(capture.alternation) {
  if (capture.background.empty()) return;
  background_ = open_frames(capture.background);
  if (background_->size() == 1) {
    common_background_ = background_->read(0);
    background_.reset();
    return;
  }
  require(background_->size() == size(),
          "expected one background for all frames or one each, got ",
          background_->size(),
          " for ",
          size(),
          " frames");
}

std::size_t CaptureFrames::size() const {
  return alternation_ == Alternation::kNone ? frames_->size() : frames_->size() / 2;
}

Image8 CaptureFrames::lit(std::size_t i) const {
  if (alternation_ == Alternation::kNone) return frames_->read(i);
  return frames_->read(2 * i + (alternation_ == Alternation::kOnFirst ? 0 : 1));
}

Image8 CaptureFrames::dark(std::size_t i) const {
  if (alternation_ != Alternation::kNone) {
    return frames_->read(2 * i + (alternation_ == Alternation::kOnFirst ? 1 : 0));
  }
  if (background_) return background_->read(i);
  return common_background_;
}

}  // namespace facula
