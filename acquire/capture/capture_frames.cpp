// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/frame_source.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/stripe/moving_pixels.hpp>

#include <string>

namespace facula {

CaptureFrames::CaptureFrames(const Capture& capture)
    : frames_(open_frames(capture.frames)),
      alternation_(capture.alternation),
      flicker_(capture.flicker),
      exposures_(capture.exposures_per_position()) {
  if (capture.background.empty()) return;
  background_ = open_frames(capture.background);
  if (background_->size() == exposures_) {
    for (std::size_t e = 0; e < exposures_; ++e) common_background_.push_back(background_->read(e));
    background_.reset();
    return;
  }
  require(background_->size() == size() * exposures_,
          "expected one background for all frames",
          exposures_ > 1 ? " of an exposure (" + std::to_string(exposures_) + ")" : "",
          " or one each, got ",
          background_->size(),
          " for ",
          size() * exposures_,
          " frames");
}

std::size_t CaptureFrames::size() const {
  return frames_->size() / (exposures_ * frames_per_exposure(alternation_));
}

Image8 CaptureFrames::frame(std::size_t i, std::size_t exposure, std::size_t number) const {
  const std::size_t of_one = frames_per_exposure(alternation_);
  return frames_->read((i * exposures_ + exposure) * of_one + number);
}

Image8 CaptureFrames::background(std::size_t i, std::size_t exposure) const {
  if (background_) return background_->read(i * exposures_ + exposure);
  return common_background_.empty() ? Image8{} : common_background_[exposure];
}

CapturedFrame CaptureFrames::read(std::size_t i, std::size_t exposure) const {
  CapturedFrame taken;
  switch (alternation_) {
    case Alternation::kNone:
      taken.lit = frame(i, exposure, 0);
      taken.dark = background(i, exposure);
      break;
    case Alternation::kOnFirst:
      taken.lit = frame(i, exposure, 0);
      taken.dark = frame(i, exposure, 1);
      break;
    case Alternation::kOffFirst:
      taken.lit = frame(i, exposure, 1);
      taken.dark = frame(i, exposure, 0);
      break;
    case Alternation::kOnOffOn:
    case Alternation::kOffOnOff: {
      const Image8 before = frame(i, exposure, 0);
      const Image8 between = frame(i, exposure, 1);
      const Image8 after = frame(i, exposure, 2);
      taken.moving = moving_pixels(before.view(), after.view());
      Image8 mean = mean_of(before.view(), after.view());
      const bool lit_twice = alternation_ == Alternation::kOnOffOn;
      taken.lit = lit_twice ? mean : between;
      taken.dark = lit_twice ? between : mean;
      break;
    }
  }
  if (flicker_ != Flicker::kIgnore && !taken.dark.empty()) {
    taken.dark = match_background(taken.lit.view(), taken.dark.view(), flicker_);
  }
  return taken;
}

Image8 CaptureFrames::lit(std::size_t i) const {
  return read(i).lit;
}

Image8 CaptureFrames::dark(std::size_t i) const {
  return read(i).dark;
}

}  // namespace facula
