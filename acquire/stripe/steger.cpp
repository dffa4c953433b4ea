// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/stripe/fir_clipped.hpp>
#include <facula/acquire/stripe/line_kernels.hpp>
#include <facula/acquire/stripe/peak_detector.hpp>
#include <facula/acquire/stripe/steger.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace facula {
namespace {

double norm(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += static_cast<double>(v) * static_cast<double>(v);
  return std::sqrt(sum);
}

/// Smoothed, first and second derivatives down the columns about one row, for some columns.
struct ColumnFilters {
  int begin = 0;
  std::vector<double> smooth;
  std::vector<double> slope;
  std::vector<double> curvature;

  double along(const std::vector<double>& values, const std::vector<float>& kernel, int c) const {
    const std::size_t first = static_cast<std::size_t>(c - begin) - kernel.size() / 2;
    double sum = 0;
    for (std::size_t i = 0; i < kernel.size(); ++i) {
      sum += static_cast<double>(kernel[i]) * values[first + i];
    }
    return sum;
  }
};

/// Where the ridge meets the row.
struct Ridge {
  double beside = 0;  ///< of the pixel, along the row [px]
  double bend = 0;    ///< across the ridge, above 0 [DN/px^2]
  double lean = 1;    ///< part of the ridge's normal that runs along the row [1]
};

class Steger : public PeakDetector {
 public:
  explicit Steger(double sigma) : PeakDetector(sigma), kernels_(line_kernels(sigma)) {}

 private:
  bool place(const Peak& peak, StripeCandidate& found) const override {
    const SignalRow& row = peak.row;
    const PeakShape& shape = peak.shape;
    const int reach = std::max(2, static_cast<int>(std::lround(2 * sigma())));
    const int from = shape.middle() - reach;
    const int to = shape.middle() + reach;
    const ColumnFilters columns = filter_columns(peak.signal, peak.r, from, to);
    int c = shape.middle();
    for (int step = 0; step < 5; ++step) {
      const auto ridge = ridge_at(columns, c);
      if (!ridge) return false;
      if (std::abs(ridge->beside) <= 0.5 + kPlay) {
        fill(row, *ridge, c, found);
        return row.holds(c);
      }
      c += static_cast<int>(std::lround(std::clamp(ridge->beside, -2.0, 2.0)));
      if (c < from || c > to) return false;
    }
    return false;
  }

  static constexpr double kPlay = 0.1;       // so that a ridge between two pixels belongs to one
  static constexpr double kLeastLean = 0.3;  // a flatter line does not cross the row in one place

  ColumnFilters filter_columns(const StripeSignal& signal, int r, int from, int to) const {
    const int radius = kernels_.radius;
    ColumnFilters columns;
    columns.begin = from - radius;
    const auto count = static_cast<std::size_t>(to - from + 2 * radius + 1);
    columns.smooth.assign(count, 0);
    columns.slope.assign(count, 0);
    columns.curvature.assign(count, 0);
    for (int d = -radius; d <= radius; ++d) {
      SignalRow row = signal.row(std::clamp(r + d, 0, signal.rows() - 1));
      if (row.empty()) row = signal.row(r);
      const auto tap = static_cast<std::size_t>(d + radius);
      for (std::size_t i = 0; i < count; ++i) {
        const double value = row.at(columns.begin + static_cast<int>(i));
        columns.smooth[i] += static_cast<double>(kernels_.smooth[tap]) * value;
        columns.slope[i] += static_cast<double>(kernels_.slope[tap]) * value;
        columns.curvature[i] += static_cast<double>(kernels_.curvature[tap]) * value;
      }
    }
    return columns;
  }

  std::optional<Ridge> ridge_at(const ColumnFilters& f, int c) const {
    const double gx = f.along(f.smooth, kernels_.slope, c);
    const double gy = f.along(f.slope, kernels_.smooth, c);
    const double xx = f.along(f.smooth, kernels_.curvature, c);  // bends: signs are turned
    const double yy = f.along(f.curvature, kernels_.smooth, c);
    const double xy = -f.along(f.slope, kernels_.slope, c);
    const double spread = std::hypot(0.5 * (xx - yy), xy);
    const double bend = 0.5 * (xx + yy) + spread;
    if (!(bend > 0) || !(spread > 0)) return std::nullopt;
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    const double nx = std::cos(angle);
    const double ny = std::sin(angle);
    if (std::abs(nx) < kLeastLean) return std::nullopt;
    return Ridge{(gx * nx + gy * ny) / bend / nx, bend, std::abs(nx)};
  }

  void fill(const SignalRow& row, const Ridge& ridge, int c, StripeCandidate& found) const {
    const auto bend = static_cast<float>(ridge.bend * ridge.lean * ridge.lean);  // along the row
    const double quiet = norm(kernels_.smooth);
    found.position = static_cast<float>(c + ridge.beside);
    found.sigma_per_noise = static_cast<float>(static_cast<double>(kernels_.slope_norm) * quiet /
                                               (ridge.bend * ridge.lean));
    found.snr_per_noise =
        static_cast<float>(ridge.bend / (static_cast<double>(kernels_.curvature_norm) * quiet));
    const double w = std::max(0.5, static_cast<double>(found.width));
    found.position_share = static_cast<float>(std::pow(1 + sigma() * sigma() / (2 * w * w), -1.5));
    found.sigma_step = static_cast<float>(1 / (8 * std::sqrt(7.0) * (w * w + sigma() * sigma())));
    if (found.saturated) judge_clipped(row, static_cast<float>(sigma()), bend, found);
  }

  LineKernels kernels_;
};

}  // namespace

std::unique_ptr<RowDetector> make_steger(double sigma) {
  return std::make_unique<Steger>(sigma);
}

}  // namespace facula
