// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/median.hpp>
#include <facula/reconstruct/register/scan_view.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

constexpr double kFlatCosine = 0.7;     // sights within 45 degrees of their mean may be flat
constexpr double kFlatResidual = 5e-3;  // of the slopes, rms [1]
constexpr double kCentral = 0.08;       // origins' spread over the median range [1]
constexpr double kPointsPerPixel = 3;   // so that a surface leaves no holes [1]
constexpr double kMaxPixels = 1024;     // along a side of the image

}  // namespace

/// The points with known origins, their unit lines of sight and ranges.
struct ScanView::Sights {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> ranges;

  explicit Sights(const PointCloud& cloud) {
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d point = cloud.points[i].cast<double>();
      const Eigen::Vector3d sight = point - cloud.sensor_origin[i].cast<double>();
      const double range = sight.norm();
      if (!(range > 0 && std::isfinite(range))) continue;
      points.push_back(point);
      directions.emplace_back(sight / range);
      ranges.push_back(range);
    }
  }

  Eigen::Vector3d mean(const std::vector<Eigen::Vector3d>& values) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& v : values) sum += v;
    return sum / static_cast<double>(values.size());
  }
};

ScanView::ScanView(const PointCloud& cloud, double spacing) {
  if (cloud.sensor_origin.empty() || !(spacing > 0)) return;
  const Sights sights(cloud);
  if (sights.points.size() < 3) return;
  pixel_ = 2 * spacing;
  if (!fit_flat(sights) && !fit_central(sights)) return;
  choose_resolution(cloud);
}

/// Slopes of the sights against the mean sight, as a line in the place where they cross its plane:
/// parallel where the line is level, a camera where it falls alike along u and v.
bool ScanView::fit_flat(const Sights& sights) {
  const Eigen::Vector3d w = sights.mean(sights.directions).normalized();
  origin_ = sights.mean(sights.points);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& d : sights.directions) {
    if (d.dot(w) < kFlatCosine) return false;
    const Eigen::Vector3d slope = d / d.dot(w) - w;
    spread += slope * slope.transpose();
  }
  // The axis along the sights has no spread: it comes first and is not asked for.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(spread);
  const Eigen::Vector3d largest = eigen.eigenvectors().col(2);
  const Eigen::Vector3d u = (largest - w.dot(largest) * w).norm() > 0.5
                                ? Eigen::Vector3d((largest - w.dot(largest) * w).normalized())
                                : Eigen::Vector3d(w.unitOrthogonal());
  axes_ << u.transpose(), w.cross(u).transpose(), w.transpose();
  Eigen::Vector2d products = Eigen::Vector2d::Zero();
  Eigen::Vector2d squares = Eigen::Vector2d::Constant(1e-12);
  double slopes = 0;
  for (std::size_t i = 0; i < sights.points.size(); ++i) {
    const Eigen::Vector3d d = axes_ * sights.directions[i];
    const Eigen::Vector3d x = axes_ * (sights.points[i] - origin_);
    const Eigen::Vector2d slope = d.head<2>() / d.z();
    const Eigen::Vector2d foot = x.head<2>() - x.z() * slope;
    products += foot.cwiseProduct(slope);
    squares += foot.cwiseAbs2();
    slopes += slope.squaredNorm();
  }
  widening_ = products.cwiseQuotient(squares);
  const double rest = slopes - widening_.dot(products);
  return rest < kFlatResidual * kFlatResidual * static_cast<double>(sights.points.size());
}

bool ScanView::fit_central(const Sights& sights) {
  central_ = true;
  axes_.setIdentity();
  origin_.setZero();
  for (std::size_t i = 0; i < sights.points.size(); ++i) {
    origin_ += sights.points[i] - sights.ranges[i] * sights.directions[i];
  }
  origin_ /= static_cast<double>(sights.points.size());
  double squares = 0;
  for (std::size_t i = 0; i < sights.points.size(); ++i) {
    squares += (sights.points[i] - sights.ranges[i] * sights.directions[i] - origin_).squaredNorm();
  }
  const double spread = std::sqrt(squares / static_cast<double>(sights.points.size()));
  std::vector<double> ranges = sights.ranges;
  const double range = median(ranges);
  slack_ = 2 * spread / range;
  pixel_ /= range;
  return spread < kCentral * range;
}

/// The finest image on which surfaces leave no holes.
void ScanView::choose_resolution(const PointCloud& cloud) {
  std::size_t usable = 0;
  Eigen::Vector2d lowest = Eigen::Vector2d::Constant(INFINITY);
  Eigen::Vector2d highest = -lowest;
  for (const Eigen::Vector3f& p : cloud.points) {
    if (!p.allFinite()) continue;
    const Eigen::Vector2d foot = flat(p.cast<double>()).head<2>();
    if (!foot.allFinite()) continue;
    lowest = lowest.cwiseMin(foot);
    highest = highest.cwiseMax(foot);
    ++usable;
  }
  corner_ = lowest;
  const Eigen::Vector2d size = central_ ? Eigen::Vector2d(2, 2) : Eigen::Vector2d(highest - lowest);
  pixel_ = std::max(pixel_, size.maxCoeff() / kMaxPixels);
  for (;; pixel_ *= 1.5) {
    cols_ = static_cast<int>(size.x() / pixel_) + 1;
    rows_ = static_cast<int>(size.y() / pixel_) + 1;
    fill(cloud);
    const auto filled = std::count_if(
        cells_.begin(), cells_.end(), [](const Cell& c) { return c.farthest >= c.nearest; });
    if (static_cast<double>(usable) >= kPointsPerPixel * static_cast<double>(filled)) return;
    if (filled < 16) return;
  }
}

void ScanView::fill(const PointCloud& cloud) {
  const std::size_t faces = central_ ? 6 : 1;
  cells_.assign(faces * static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_), {});
  for (const Eigen::Vector3f& x : cloud.points) {
    if (!x.allFinite()) continue;
    const Pixel p = project(x.cast<double>());
    if (!p.inside) continue;
    Cell& c = cell(p.face, p.row, p.col);
    const auto depth = static_cast<float>(p.depth);
    const bool first = c.farthest < c.nearest;
    c.nearest = first ? depth : std::min(c.nearest, depth);
    c.farthest = first ? depth : std::max(c.farthest, depth);
  }
}

ScanView::Cell& ScanView::cell(int face, int row, int col) {
  return cells_[(static_cast<std::size_t>(face) * static_cast<std::size_t>(rows_) +
                 static_cast<std::size_t>(row)) *
                    static_cast<std::size_t>(cols_) +
                static_cast<std::size_t>(col)];
}

/// Where the line of sight through x crosses the plane through the origin, and x's depth beyond it.
Eigen::Vector3d ScanView::flat(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d local = axes_ * (x - origin_);
  const double u = 1 + local.z() * widening_.x();
  const double v = 1 + local.z() * widening_.y();
  // At or behind the place where the lines of sight meet there is no image.
  if (!(u > 0.05 && v > 0.05)) return Eigen::Vector3d::Constant(NAN);
  return {local.x() / u, local.y() / v, local.z()};
}

ScanView::Pixel ScanView::project(const Eigen::Vector3d& x) const {
  Pixel p;
  double u = 0;
  double v = 0;
  if (central_) {
    const Eigen::Vector3d local = x - origin_;
    Eigen::Index axis = 0;
    const double size = local.cwiseAbs().maxCoeff(&axis);
    if (!(size > 0)) return p;
    p.face = static_cast<int>(2 * axis) + (local[axis] < 0 ? 1 : 0);
    u = local[(axis + 1) % 3] / size + 1;
    v = local[(axis + 2) % 3] / size + 1;
    p.depth = local.norm();
  } else {
    const Eigen::Vector3d foot = flat(x);
    u = foot.x() - corner_.x();
    v = foot.y() - corner_.y();
    p.depth = foot.z();
  }
  if (!(u >= 0 && v >= 0 && u / pixel_ < cols_ && v / pixel_ < rows_)) return p;
  p.col = static_cast<int>(u / pixel_);
  p.row = static_cast<int>(v / pixel_);
  p.inside = true;
  return p;
}

Seen ScanView::at(const Eigen::Vector3d& x, double margin) const {
  if (empty()) return Seen::kUnknown;
  const Pixel p = project(x);
  if (!p.inside || p.row < 1 || p.col < 1 || p.row + 1 >= rows_ || p.col + 1 >= cols_) {
    return Seen::kUnknown;
  }
  double nearest = INFINITY;
  double farthest = -INFINITY;
  const auto cols = static_cast<std::size_t>(cols_);
  const Cell* row = &cells_[(static_cast<std::size_t>(p.face) * static_cast<std::size_t>(rows_) +
                             static_cast<std::size_t>(p.row - 1)) *
                                cols +
                            static_cast<std::size_t>(p.col - 1)];
  for (int i = 0; i < 3; ++i, row += cols) {
    for (int j = 0; j < 3; ++j) {
      if (row[j].farthest < row[j].nearest) return Seen::kUnknown;  // at the edge of what was seen
      nearest = std::min(nearest, static_cast<double>(row[j].nearest));
      farthest = std::max(farthest, static_cast<double>(row[j].farthest));
    }
  }
  const double allowed = margin + slack_ * std::abs(p.depth);
  if (p.depth < nearest - allowed) return Seen::kFree;
  return p.depth <= farthest + allowed ? Seen::kSurface : Seen::kUnknown;
}

}  // namespace facula
