// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/brightest_pixel.hpp>
#include <facula/acquire/stripe/peak_detector.hpp>

#include <cmath>
#include <numbers>

namespace facula {
namespace {

class BrightestPixel : public PeakDetector {
 public:
  BrightestPixel(double sigma, double threshold, bool halves)
      : PeakDetector(sigma), threshold_(threshold), halves_(halves) {}

 private:
  bool place(const Peak& peak, StripeCandidate& found) const override {
    const PeakShape& shape = peak.shape;
    if (shape.height() < threshold_) return false;
    if (halves_) found.position = 0.5F * static_cast<float>(shape.first + shape.last);
    found.sigma_step = static_cast<float>(1 / std::sqrt(12.0));
    const float w = found.width;
    found.sigma_per_noise = std::numbers::sqrt2_v<float> * w * w / found.amplitude;
    found.position_share = 1;  // the pixels that compete stand at the top
    return true;
  }

  double threshold_;
  bool halves_;
};

}  // namespace

std::unique_ptr<RowDetector> make_brightest_pixel(double sigma) {
  return std::make_unique<BrightestPixel>(sigma, 0.0, false);
}

std::unique_ptr<RowDetector> make_maximum_threshold(double sigma, double threshold) {
  return std::make_unique<BrightestPixel>(sigma, threshold, true);
}

}  // namespace facula
