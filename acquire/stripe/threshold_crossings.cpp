// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/peak_detector.hpp>
#include <facula/acquire/stripe/position_noise.hpp>
#include <facula/acquire/stripe/threshold_crossings.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace facula {
namespace {

class ThresholdCrossings : public PeakDetector {
 public:
  ThresholdCrossings(double sigma, std::vector<double> shares)
      : PeakDetector(sigma), shares_(std::move(shares)) {}

 private:
  /// Rounding a crossing that noise n moves by n / slope adds (n / slope)^2 to its variance,
  /// however small the noise: a crossing delta before the next pixel falls to it with probability
  /// Q(delta slope / n) at the cost of 2 delta.
  bool place(const Peak& peak, StripeCandidate& found) const override {
    const SignalRow& row = peak.row;
    const PeakShape& shape = peak.shape;
    const double share_of_each = 0.5 / static_cast<double>(shares_.size());
    double position = 0;
    PositionNoise noise;
    std::vector<double> places;
    for (const double share : shares_) {
      const auto at = crossings(row, shape, share);
      if (!at) return false;
      position += share_of_each * (std::ceil(at->left) + std::floor(at->right));
      noise.add(share_of_each / at->left_slope, share * shape.height());
      noise.add(share_of_each / at->right_slope, share * shape.height());
      const double half = 0.5 * (at->right - at->left);
      places.push_back(half);
      places.push_back(-half);
    }
    found.position = static_cast<float>(position);
    found.sigma_step = static_cast<float>(std::sqrt(step_variance(places)));
    noise.store(found);
    return true;
  }

  std::vector<double> shares_;  ///< of the height
};

}  // namespace

std::unique_ptr<RowDetector> make_one_threshold(double sigma) {
  return std::make_unique<ThresholdCrossings>(sigma, std::vector<double>{0.5});
}

std::unique_ptr<RowDetector> make_two_thresholds(double sigma) {
  return std::make_unique<ThresholdCrossings>(sigma, std::vector<double>{1.0 / 3, 2.0 / 3});
}

double step_variance(std::vector<double> places) {
  for (double& place : places) place -= std::floor(place);
  std::sort(places.begin(), places.end());
  const auto count = static_cast<double>(places.size());
  // Between two steps the error is j / N - m, m the line's place: a ramp of slope -1.
  double mean = 0;
  double square = 0;
  for (std::size_t j = 0; j < places.size(); ++j) {
    const double from = places[j];
    const double to = j + 1 < places.size() ? places[j + 1] : places.front() + 1;
    const double high = static_cast<double>(j) / count - from;
    const double low = static_cast<double>(j) / count - to;
    mean += 0.5 * (high * high - low * low);
    square += (high * high * high - low * low * low) / 3;
  }
  return square - mean * mean;
}

}  // namespace facula
