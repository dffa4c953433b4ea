// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/two_line/two_line_segments.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace facula {
namespace {

/// A stripe's point on the ideal picture.
struct LinePoint {
  Eigen::Vector2d pixel;  ///< [px]
  double sigma = 0;       ///< along y [px]
};

std::vector<LinePoint> ideal_points(const StripeProfile& profile, const Rig& rig) {
  std::vector<LinePoint> points;
  for (std::size_t u = 0; u < profile.size(); ++u) {
    if (profile.seen[u] == 0) continue;
    const Eigen::Vector2d pixel(static_cast<double>(u), static_cast<double>(profile.position[u]));
    const auto normalized = rig.camera.undistort(pixel);
    if (!normalized) continue;
    const double sigma = std::max(1e-3, static_cast<double>(profile.sigma[u]));
    points.push_back({ideal_pixel(*normalized, rig), sigma});
  }
  return points;
}

struct RowAt {
  double row = 0;    ///< [px]
  double sigma = 0;  ///< [px]
};

/// Weighted least squares line through the points of a segment, at its middle; the sigma is raised
/// where the points scatter more than their own sigmas say.
std::optional<RowAt> row_at(const std::vector<LinePoint>& points, double centre, double width) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  std::vector<LinePoint> own;
  for (const LinePoint& p : points) {
    if (std::abs(p.pixel.x() - centre) > 0.5 * width) continue;
    const double weight = 1 / (p.sigma * p.sigma);
    const Eigen::Vector2d row(1, (p.pixel.x() - centre) / width);
    normal += weight * row * row.transpose();
    right += weight * p.pixel.y() * row;
    own.push_back(p);
  }
  if (static_cast<double>(own.size()) < std::max(4.0, 0.25 * width)) return std::nullopt;
  const double determinant = normal(0, 0) * normal(1, 1) - normal(0, 1) * normal(1, 0);
  if (!(determinant > 1e-9 * normal(0, 0) * normal(0, 0))) return std::nullopt;
  const double row = (normal(1, 1) * right[0] - normal(0, 1) * right[1]) / determinant;
  const double slope = (normal(0, 0) * right[1] - normal(0, 1) * right[0]) / determinant;
  double chi_square = 0;
  for (const LinePoint& p : own) {
    const double left = p.pixel.y() - row - slope * (p.pixel.x() - centre) / width;
    chi_square += left * left / (p.sigma * p.sigma);
  }
  const double reduced = chi_square / (static_cast<double>(own.size()) - 2);
  return RowAt{row, std::sqrt(normal(1, 1) / determinant * std::max(1.0, reduced))};
}

}  // namespace

void find_by_stripes(ImageView8 frame,
                     ImageView8 background,
                     const Rig& rig,
                     const TwoLineOptions& options,
                     std::vector<TwoLineReading>& readings) {
  const int middle = std::clamp(static_cast<int>(std::lround(rig.camera.cy)), 1, frame.rows - 1);
  StripeOptions stripe = options.stripe;
  stripe.direction = StripeDirection::kPerColumn;
  stripe.region = {0, 0, frame.cols, middle};
  const auto upper = ideal_points(detect_stripe(frame, background, stripe), rig);
  stripe.region = {0, middle, frame.cols, frame.rows - middle};
  const auto lower = ideal_points(detect_stripe(frame, background, stripe), rig);
  for (TwoLineReading& reading : readings) {
    const auto above = row_at(upper, reading.centre_px, options.segment_width);
    const auto below = row_at(lower, reading.centre_px, options.segment_width);
    if (!above || !below) {
      reading.failure = above ? "no line below the camera's axis"
                              : (below ? "no line above the camera's axis" : "no line");
      continue;
    }
    reading.upper_px = above->row;
    reading.lower_px = below->row;
    reading.separation_sigma_px = std::hypot(above->sigma, below->sigma);
  }
}

}  // namespace facula
