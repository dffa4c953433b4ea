// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/log_gauss.hpp>
#include <facula/acquire/stripe/peak_detector.hpp>
#include <facula/acquire/stripe/position_noise.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace facula {
namespace {

/// Pixels of a row that take part in the fit; places are counted from `origin`.
struct FitWindow {
  SignalRow row;
  int begin = 0;
  int end = 0;
  int origin = 0;
  double background = 0;

  double height(int c) const { return row.at(c) - background; }
  bool counts(int c) const { return height(c) > 0 && !row.is_clipped(c); }
  Eigen::Vector3d basis(int c) const {
    const double x = c - origin;
    return {1, x, x * x};
  }
};

/// ln of the line: coefficients of 1, x, x^2, and the inverse of their normal matrix.
struct LogFit {
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();

  double height(const FitWindow& window, int c) const {
    return std::exp(coefficients.dot(window.basis(c)));
  }
  double top() const { return -coefficients[1] / (2 * coefficients[2]); }
};

/// Weights are the squares of the heights of `before`, or of the pixels themselves.
std::optional<LogFit> fit(const FitWindow& window, const LogFit* before) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int c = window.begin; c < window.end; ++c) {
    if (!window.counts(c)) continue;
    const double height = before != nullptr ? before->height(window, c) : window.height(c);
    const Eigen::Vector3d x = window.basis(c);
    normal += height * height * x * x.transpose();
    right += height * height * std::log(window.height(c)) * x;
  }
  LogFit found;
  bool invertible = false;
  normal.computeInverseWithCheck(found.inverse, invertible);
  if (!invertible) return std::nullopt;
  found.coefficients = found.inverse * right;
  const double top = found.top() + window.origin;
  if (!(found.coefficients[2] < 0) || !(top >= window.begin - 0.5 && top <= window.end - 0.5)) {
    return std::nullopt;
  }
  return found;
}

class LogGauss : public PeakDetector {
 public:
  explicit LogGauss(double sigma) : PeakDetector(sigma) {}

 private:
  bool place(const Peak& peak, StripeCandidate& found) const override {
    const SignalRow& row = peak.row;
    const PeakShape& shape = peak.shape;
    const FitWindow window = window_about(row, shape, found);
    const auto rough = fit(window, nullptr);
    if (!rough) return false;
    const auto line = fit(window, &*rough);
    if (!line) return false;
    fill(window, *line, shape, found);
    return true;
  }

  FitWindow window_about(const SignalRow& row,
                         const PeakShape& shape,
                         const StripeCandidate& found) const {
    const double width = std::clamp(static_cast<double>(found.width), 0.7, 4 * sigma());
    const double middle = 0.5 * (shape.first + shape.last);
    const double reach = std::max(1.0, 1.5 * width) + 0.5 * (shape.last - shape.first);
    FitWindow window;
    window.row = row;
    window.begin = std::max(row.begin, static_cast<int>(std::ceil(middle - reach)));
    window.end = std::min(row.end, static_cast<int>(std::floor(middle + reach)) + 1);
    window.origin = shape.middle();
    window.background = shape.background;
    return window;
  }

  static void fill(const FitWindow& window,
                   const LogFit& line,
                   const PeakShape& shape,
                   StripeCandidate& found) {
    const double c2 = line.coefficients[2];
    const double top = line.top();
    found.position = static_cast<float>(window.origin + top);
    found.width = static_cast<float>(std::sqrt(-0.5 / c2));
    found.amplitude = static_cast<float>(std::exp(line.coefficients[0] - c2 * top * top));
    PositionNoise noise;
    for (int c = window.begin; c < window.end; ++c) {
      if (!window.counts(c)) continue;
      const double height = line.height(window, c);
      const Eigen::Vector3d moved = height * (line.inverse * window.basis(c));
      noise.add(-(moved[1] + 2 * top * moved[2]) / (2 * c2), height);
    }
    noise.share_background(shape.background_count);
    noise.store(found);
  }
};

}  // namespace

std::unique_ptr<RowDetector> make_log_gauss(double sigma) {
  return std::make_unique<LogGauss>(sigma);
}

}  // namespace facula
