// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/measure/bounding_rectangle.hpp>
#include <facula/reconstruct/measure/tolerance_zone.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace facula {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr double kUnknownWay = 3;  // sigmas below which a tilt's direction is not known [1]

/// Least and largest of the points along a direction, and who they are.
struct Span {
  std::size_t low = 0;
  std::size_t high = 0;
  double length = 0;
};

Span span_along(const Points& points, const Eigen::Vector3d& direction) {
  Span span;
  if (points.empty()) return span;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double along = points[i].dot(direction);
    if (along < points[span.low].dot(direction)) span.low = i;
    if (along > points[span.high].dot(direction)) span.high = i;
  }
  span.length = (points[span.high] - points[span.low]).dot(direction);
  return span;
}

/// How far the tilts of surface and datum move the two ends of `apart` against each other, along
/// the datum's normal.
double pair_variance(const PlaneFit& surface,
                     const PlaneFit& datum,
                     const Eigen::Vector3d& apart,
                     const RelationOptions& options) {
  const double side = datum.plane.normal.dot(surface.plane.normal);
  const auto tilted = [&apart](const PlaneFit& fit) {
    return Eigen::Vector3d(apart.dot(fit.axis_u), apart.dot(fit.axis_v), 0);
  };
  return joint_variance({datum, tilted(datum)}, {surface, -side * tilted(surface)}, options);
}

double largest_pair_variance(const PlaneFit& surface,
                             const PlaneFit& datum,
                             const RelationOptions& options) {
  double largest = 0;
  for (const Eigen::Vector3d& p : surface.outline) {
    for (const Eigen::Vector3d& q : surface.outline) {
      largest = std::max(largest, pair_variance(surface, datum, q - p, options));
    }
  }
  return largest;
}

/// Width of the narrowest strip that holds the points' shadows along `datum_normal`.
double narrowest_shadow(const Points& points, const Eigen::Vector3d& datum_normal) {
  if (points.empty()) return 0;
  const Eigen::Vector3d u = datum_normal.unitOrthogonal();
  const Eigen::Vector3d v = datum_normal.cross(u);
  std::vector<Eigen::Vector2d> shadow;
  shadow.reserve(points.size());
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d d = p - points.front();
    shadow.emplace_back(d.dot(u), d.dot(v));
  }
  return smallest_width(convex_hull(std::move(shadow)));
}

void require_datum(const PlaneFit& surface, double datum_cosine, bool holds, const char* relation) {
  require(holds,
          "the surface stands at ",
          std::acos(std::min(1.0, std::abs(datum_cosine))) * 180 / M_PI,
          " degrees to its datum, which is no case for ",
          relation,
          "; choose planes nearer to it");
  require(surface.outline.size() >= 3,
          "the surface has an outline of ",
          surface.outline.size(),
          " corners; fit it to points first");
}

}  // namespace

ToleranceZone parallelism(const PlaneFit& surface,
                          const PlaneFit& datum,
                          const std::vector<Eigen::Vector3d>& points,
                          const RelationOptions& options) {
  options.check();
  const double cosine = surface.plane.normal.dot(datum.plane.normal);
  require_datum(surface, cosine, std::abs(cosine) > M_SQRT1_2, "parallelism");
  const Span span = span_along(surface.outline, datum.plane.normal);
  const Eigen::Vector3d apart = surface.outline[span.high] - surface.outline[span.low];
  double variance = pair_variance(surface, datum, apart, options);
  const double largest = largest_pair_variance(surface, datum, options);
  if (span.length < kUnknownWay * std::sqrt(std::max(variance, largest))) variance += largest;
  return {{span.length, std::sqrt(variance)}, span_along(points, datum.plane.normal).length};
}

ToleranceZone perpendicularity(const PlaneFit& surface,
                               const PlaneFit& datum,
                               const std::vector<Eigen::Vector3d>& points,
                               const RelationOptions& options) {
  options.check();
  const double sine = surface.plane.normal.dot(datum.plane.normal);
  require_datum(surface, sine, std::abs(sine) < M_SQRT1_2, "perpendicularity");
  const double height = span_along(surface.outline, datum.plane.normal).length;
  const double tangent = std::abs(sine) / std::sqrt(1 - sine * sine);
  const double angle_sigma = measured_angle(surface, datum, options).sigma;
  return {{height * tangent, height * angle_sigma / (1 - sine * sine)},
          narrowest_shadow(points, datum.plane.normal)};
}

}  // namespace facula
