// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/tests/acquire/stripe/line_image.hpp>

#include <cmath>
#include <numbers>

#include <Eigen/LU>

namespace facula {

/// Least standard deviations of an unbiased position from one row of a LineImage [px].
struct LineBound {
  double known_shape = 0;  ///< height, width, level and slope of the level known
  double unknown = 0;  ///< height, width and level (and its slope, where there is one) not known
};

namespace bound_detail {

inline double normal_density(double z) {
  return std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
}

inline double normal_below(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

/// Share of a normal value's information on its mean that is left when values above z standard
/// deviations are only known to lie there (Tobin 1958).
inline double left_of_censored(double z) {
  if (z > 8) return 1;
  if (z < -30) return 0;
  const double above = normal_below(-z);
  return normal_below(z) - z * normal_density(z) + normal_density(z) * normal_density(z) / above;
}

/// Fisher information on middle, height, width, level and slope of the level, of a row whose line
/// lies at `middle`. The pixels' variance is taken as known: noise, photons and 1/12 for rounding.
inline Eigen::Matrix<double, 5, 5> information(const LineImage& line, double middle) {
  Eigen::Matrix<double, 5, 5> sum = Eigen::Matrix<double, 5, 5>::Zero();
  const double root = std::sqrt(2 * std::numbers::pi);
  for (int c = 0; c < line.cols; ++c) {
    const double zl = (c - 0.5 - middle) / line.sigma;
    const double zr = (c + 0.5 - middle) / line.sigma;
    const double inside = normal_below(zr) - normal_below(zl);
    const double light = line.amplitude * line.sigma * root * inside;
    Eigen::Matrix<double, 5, 1> by;
    by << line.amplitude * root * (normal_density(zl) - normal_density(zr)),
        line.sigma * root * inside,
        line.amplitude * root * (inside - zr * normal_density(zr) + zl * normal_density(zl)), 1,
        c - middle;
    const double mean = line.background + line.slope * c + light;
    const double noise = std::sqrt(line.noise * line.noise + line.photons * light + 1.0 / 12);
    const double clipped = left_of_censored((254.5 - mean) / noise);  // 255 means "254.5 or more"
    const double dark = left_of_censored((mean - 0.5) / noise);
    sum += std::max(0.0, clipped + dark - 1) / (noise * noise) * by * by.transpose();
  }
  return sum;
}

}  // namespace bound_detail

/// Cramér-Rao bound of the pixel-integrated, rounded and clipped line: root mean square over the
/// places within a pixel.
inline LineBound line_bound(const LineImage& line) {
  constexpr int kPlaces = 16;
  const int fitted = line.slope != 0 ? 5 : 4;
  LineBound bound;
  for (int i = 0; i < kPlaces; ++i) {
    const auto all = bound_detail::information(line, 0.5 * line.cols + (i + 0.5) / kPlaces);
    bound.known_shape += 1 / all(0, 0) / kPlaces;
    bound.unknown += Eigen::MatrixXd(all.topLeftCorner(fitted, fitted)).inverse()(0, 0) / kPlaces;
  }
  bound.known_shape = std::sqrt(bound.known_shape);
  bound.unknown = std::sqrt(bound.unknown);
  return bound;
}

}  // namespace facula
