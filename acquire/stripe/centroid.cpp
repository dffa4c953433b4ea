// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/centroid.hpp>
#include <facula/acquire/stripe/peak_detector.hpp>
#include <facula/acquire/stripe/position_noise.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace facula {
namespace {

constexpr int kReach = 10;  // [px], source B (2.3)

/// Columns [begin, end) whose heights over `level` are the weights of the mean.
struct Weighing {
  int begin = 0;
  int end = 0;
  double level = 0;
};

/// Mean and its noise; false where the weights do not sum to a mean within the columns.
bool weigh(const SignalRow& row, const Weighing& over, int level_count, StripeCandidate& found) {
  double weight = 0;
  double moment = 0;
  for (int c = over.begin; c < over.end; ++c) {
    weight += row.at(c) - over.level;
    moment += (row.at(c) - over.level) * c;
  }
  if (!(weight > 0)) return false;
  const double mean = moment / weight;
  if (!(mean >= over.begin && mean <= over.end - 1)) return false;
  PositionNoise noise;
  for (int c = over.begin; c < over.end; ++c) {
    noise.add((c - mean) / weight, row.at(c) - static_cast<double>(found.background));
  }
  noise.share_background(level_count);
  noise.store(found);
  found.position = static_cast<float>(mean);
  return true;
}

class Centroid : public PeakDetector {
 public:
  explicit Centroid(double sigma) : PeakDetector(sigma) {}

 private:
  bool place(const Peak& peak, StripeCandidate& found) const override {
    const SignalRow& row = peak.row;
    const PeakShape& shape = peak.shape;
    const Weighing over = {std::max(row.begin, shape.middle() - kReach),
                           std::min(row.end, shape.middle() + kReach + 1),
                           shape.background};
    if (!weigh(row, over, shape.background_count, found)) return false;
    found.sigma_step = cut_by_window(static_cast<double>(found.width));
    return true;
  }

  static float cut_by_window(double width) {
    constexpr double kHalf = kReach + 0.5;
    const double z = kHalf / std::max(0.1, width);
    const double density = std::exp(-0.5 * z * z) / (width * std::sqrt(2 * std::numbers::pi));
    return static_cast<float>(2 * kHalf * density / std::sqrt(12.0));
  }
};

class ThresholdCentroid : public PeakDetector {
 public:
  ThresholdCentroid(double sigma, double threshold) : PeakDetector(sigma), threshold_(threshold) {}

 private:
  bool place(const Peak& peak, StripeCandidate& found) const override {
    const SignalRow& row = peak.row;
    const PeakShape& shape = peak.shape;
    Weighing over = {shape.middle(), shape.middle(), shape.background + threshold_};
    if (!(row.at(over.begin) > over.level)) return false;
    while (row.holds(over.begin - 1) && row.at(over.begin - 1) > over.level) --over.begin;
    while (row.holds(over.end) && row.at(over.end) > over.level) ++over.end;
    if (!weigh(row, over, shape.background_count, found)) return false;
    // A single pixel's mean is its middle, wherever in it the line lies.
    if (over.end - over.begin == 1) found.sigma_step = static_cast<float>(1 / std::sqrt(12.0));
    return true;
  }

  double threshold_;
};

}  // namespace

std::unique_ptr<RowDetector> make_centroid(double sigma) {
  return std::make_unique<Centroid>(sigma);
}

std::unique_ptr<RowDetector> make_threshold_centroid(double sigma, double threshold) {
  return std::make_unique<ThresholdCentroid>(sigma, threshold);
}

}  // namespace facula
