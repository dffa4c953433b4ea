// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/acquire/triangulate/sheet_table.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace facula {
namespace {

constexpr int kWidest = 32;         // spacing tried first [px]
constexpr int kNarrowest = 2;       // and last: no lens is that crooked [px]
constexpr double kRayError = 1e-7;  // [px]
constexpr double kFirst = -0.5;     // the image's border [px]
constexpr int kCheckedRows = 16;    // the distortion is smooth from row to row
constexpr double kGrazing = 1e-9;   // as in LaserPlane::intersect()

}  // namespace

SheetTable::SheetTable(const Rig& rig, std::size_t laser, int num_threads)
    : rig_(rig), laser_(laser), per_row_(rig.stripe_direction == StripeDirection::kPerRow) {
  require(laser < rig.light_count(),
          "expected a laser below ",
          rig.light_count(),
          ", the number in the rig, got ",
          laser);
  if (rig.lasers.empty()) return;
  const LaserPlane& sheet = rig.lasers[laser];
  tan_bow_ = std::tan(sheet.bow);
  fan_origin_ = sheet.fan_origin();
  fan_axis_ = sheet.fan_axis();
  rows_ = per_row_ ? rig.camera.height : rig.camera.width;
  cols_ = per_row_ ? rig.camera.width : rig.camera.height;
  for (spacing_ = kWidest;; spacing_ /= 2) {
    nodes_ = (cols_ + spacing_ - 1) / spacing_ + 1;
    rays_.resize(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(nodes_));
    for (int k = 0; k <= kCheckedRows; ++k) fill_row(k * (rows_ - 1) / kCheckedRows);
    ray_error_ = worst_midway();
    if (ray_error_ <= kRayError || spacing_ <= kNarrowest) break;
  }
  parallel_for(static_cast<std::size_t>(rows_),
               [&](std::size_t begin, std::size_t end) {
                 for (std::size_t row = begin; row < end; ++row) fill_row(static_cast<int>(row));
               },
               {.num_threads = num_threads});
}

Eigen::Vector2d SheetTable::pixel(int row, double position) const {
  const auto along = static_cast<double>(row);
  return per_row_ ? Eigen::Vector2d(position, along) : Eigen::Vector2d(along, position);
}

/// Newton's method from the ray next to it, or from scratch; NaN where there is no ray.
SheetTable::Ray SheetTable::exact_ray(const Eigen::Vector2d& at,
                                      const Eigen::Vector2d* start) const {
  const Camera& camera = rig_.camera;
  const Eigen::Vector2d wanted((at.x() - camera.cx) / camera.fx, (at.y() - camera.cy) / camera.fy);
  std::optional<Eigen::Vector2d> n;
  if (start != nullptr) {
    Eigen::Vector2d guess = *start;
    for (int i = 0; i < 4 && !n; ++i) {
      const Eigen::Vector2d error = camera.distort(guess) - wanted;
      if (error.squaredNorm() < 1e-26) n = guess;
      guess -= camera.distortion_jacobian(guess).inverse() * error;
    }
  }
  if (!n) n = camera.undistort(at);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (!n) return {kNone, kNone, kNone, kNone};
  const Eigen::Matrix2d inverse = camera.distortion_jacobian(*n).inverse();
  const Eigen::Vector2d slope =
      per_row_ ? Eigen::Vector2d(inverse.col(0) / camera.fx) : inverse.col(1) / camera.fy;
  return {n->x(), n->y(), slope.x(), slope.y()};
}

void SheetTable::fill_row(int row) {
  Ray* ray = rays_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(nodes_);
  Eigen::Vector2d guess;
  for (int i = 0; i < nodes_; ++i, ++ray) {
    const bool known = i > 0 && std::isfinite(guess.x());
    *ray = exact_ray(pixel(row, kFirst + i * spacing_), known ? &guess : nullptr);
    guess = {ray->x + spacing_ * ray->dx, ray->y + spacing_ * ray->dy};
  }
}

/// Cubic between two columns (Hermite's form), and its derivative.
SheetTable::Ray SheetTable::interpolated(int row, double position) const {
  const double h = spacing_;
  const double t = (position - kFirst) / h;
  const auto i = static_cast<std::size_t>(t);
  const double s = t - static_cast<double>(i);
  const Ray* a =
      rays_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(nodes_) + i;
  const Ray* b = a + 1;
  const auto value = [&](double from, double to, double slope_from, double slope_to) {
    const double rise = to - from;
    const double c = slope_from * h - rise;
    const double d = rise - slope_to * h;
    return from + s * rise + s * (1 - s) * ((1 - s) * c + s * d);
  };
  const auto slope = [&](double from, double to, double slope_from, double slope_to) {
    const double rise = to - from;
    const double c = slope_from * h - rise;
    const double d = rise - slope_to * h;
    return (rise + (1 - 4 * s + 3 * s * s) * c + (2 * s - 3 * s * s) * d) / h;
  };
  return {value(a->x, b->x, a->dx, b->dx),
          value(a->y, b->y, a->dy, b->dy),
          slope(a->x, b->x, a->dx, b->dx),
          slope(a->y, b->y, a->dy, b->dy)};
}

/// Largest distance between interpolated and exact rays midway between the columns, over the
/// checked rows [px].
double SheetTable::worst_midway() const {
  double worst = 0;
  for (int k = 0; k <= kCheckedRows; ++k) {
    const int row = k * (rows_ - 1) / kCheckedRows;
    for (int i = 0; i + 1 < nodes_; ++i) {
      const double position = kFirst + (i + 0.5) * spacing_;
      const Ray ray = interpolated(row, position);
      if (!std::isfinite(ray.x)) continue;
      const Eigen::Vector2d guess(ray.x, ray.y);
      const Ray exact = exact_ray(pixel(row, position), &guess);
      worst = std::max({worst,
                        std::abs(exact.x - ray.x) * rig_.camera.fx,
                        std::abs(exact.y - ray.y) * rig_.camera.fy});
    }
  }
  return worst;
}

/// Gradient of LaserPlane::sheet_distance().
Eigen::Vector3d SheetTable::sheet_gradient(const Eigen::Vector3d& x) const {
  const Eigen::Vector3d& normal = rig_.lasers[laser_].normal;
  if (tan_bow_ == 0) return normal;
  const Eigen::Vector3d rho = x - fan_origin_;
  const Eigen::Vector3d in_plane = rho - normal.dot(rho) * normal;
  return normal - tan_bow_ * (in_plane.normalized() - fan_axis_);
}

/// Length along the ray up to the sheet, as LaserPlane::intersect() finds it.
std::optional<double> SheetTable::meet_sheet(const Eigen::Vector3d& direction) const {
  const LaserPlane& sheet = rig_.lasers[laser_];
  const double approach = sheet.normal.dot(direction);
  const double grazing = kGrazing * direction.norm();
  if (std::abs(approach) < grazing) return std::nullopt;
  double t = sheet.distance / approach;
  if (!(t > 0)) return std::nullopt;
  for (int i = 0; i < 8 && tan_bow_ != 0; ++i) {
    const Eigen::Vector3d x = t * direction;
    const Eigen::Vector3d rho = x - fan_origin_;
    const double height = sheet.normal.dot(rho);
    const Eigen::Vector3d in_plane = rho - height * sheet.normal;
    const double off = sheet.normal.dot(x) - sheet.distance -
                       tan_bow_ * (in_plane.norm() - in_plane.dot(fan_axis_));
    const double slope = sheet_gradient(x).dot(direction);
    if (std::abs(slope) < grazing) return std::nullopt;
    const double step = off / slope;
    t -= step;
    if (!(t > 0)) return std::nullopt;
    if (std::abs(step) < 1e-13 * t) break;
  }
  return t;
}

std::optional<TriangulatedPoint> SheetTable::at(int row,
                                                double position,
                                                double pixel_sigma) const {
  const bool inside = row >= 0 && row < rows_ && position >= kFirst &&
                      position < kFirst + static_cast<double>((nodes_ - 1) * spacing_);
  if (!inside) return triangulate(rig_, laser_, pixel(row, position), pixel_sigma);
  const Ray ray = interpolated(row, position);
  if (!std::isfinite(ray.x + ray.y + ray.dx + ray.dy)) {
    return triangulate(rig_, laser_, pixel(row, position), pixel_sigma);
  }
  const Eigen::Vector3d direction(ray.x, ray.y, 1);
  const std::optional<double> t = meet_sheet(direction);
  if (!t) return std::nullopt;
  // The point stays on the sheet as the ray turns: gradient . d(t direction) = 0.
  const Eigen::Vector3d x = *t * direction;
  const Eigen::Vector3d turn = *t * Eigen::Vector3d(ray.dx, ray.dy, 0);
  const Eigen::Vector3d gradient = sheet_gradient(x);
  const double growth = -gradient.dot(turn) / gradient.dot(direction);
  const double along_ray = (growth * direction + turn).dot(direction) / direction.norm();
  return TriangulatedPoint{x, std::abs(along_ray) * pixel_sigma};
}

}  // namespace facula
