// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/filter/point_spacing.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>
#include <facula/reconstruct/measure/largest_piece.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/measure/ransac_plane.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>

namespace facula {
namespace {

using Indices = std::vector<std::size_t>;

constexpr std::size_t kSample = 12000;  // points among which RANSAC counts [1]
constexpr int kRefinements = 12;
constexpr int kFailures = 4;  // candidates too small before the search ends

/// Up to kSample points of the pool, drawn without putting back (Fisher and Yates).
std::vector<Eigen::Vector3f> draw_sample(const PointCloud& cloud, Indices pool, Random& random) {
  const std::size_t count = std::min(kSample, pool.size());
  std::vector<Eigen::Vector3f> sample;
  sample.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(pool[i], pool[i + random.below(pool.size() - i)]);
    sample.push_back(cloud.points[pool[i]]);
  }
  return sample;
}

/// Points of the pool within `reach` of the plane whose normals agree with it.
Indices points_near(const PointCloud& cloud,
                    const Indices& pool,
                    const Plane& plane,
                    double reach,
                    double max_normal_angle) {
  const double min_cosine = std::cos(max_normal_angle);
  Indices near;
  for (const std::size_t i : pool) {
    if (std::abs(plane.signed_distance(cloud.points[i].cast<double>())) > reach) continue;
    if (!cloud.normals.empty()) {
      const Eigen::Vector3d n = cloud.normals[i].cast<double>();
      if (std::abs(n.dot(plane.normal)) < min_cosine) continue;
    }
    near.push_back(i);
  }
  return near;
}

/// How far apart the points lie: each from its nearest, and all from stripe to stripe.
struct Sampling {
  std::vector<float> spacing;
  double across = 0;
};

/// The gap that parts of one plane may have between them.
double gap_of(const Indices& points,
              const Sampling& sampling,
              const PlaneExtractionOptions& options) {
  if (options.max_gap > 0) return options.max_gap;
  std::vector<float> here;
  here.reserve(points.size());
  for (const std::size_t i : points) here.push_back(sampling.spacing[i]);
  return std::max(
      {8 * quantile(std::move(here), 0.95), 3 * sampling.across, 2 * options.inlier_distance});
}

/// Gathers, keeps the largest piece and fits in turn until the plane takes in no more points.
std::optional<ExtractedPlane> refine(const PointCloud& cloud,
                                     const Indices& pool,
                                     const Sampling& sampling,
                                     Plane plane,
                                     const PlaneExtractionOptions& options) {
  std::optional<ExtractedPlane> best;
  for (int round = 0; round < kRefinements; ++round) {
    const Indices near =
        points_near(cloud, pool, plane, options.inlier_distance, options.max_normal_angle);
    if (near.size() < 3) return best;
    Indices piece = largest_piece(cloud, near, plane, gap_of(near, sampling, options));
    if (piece.size() < 3 || (best && piece.size() <= best->indices.size())) return best;
    PlaneFit fit;
    try {
      fit = fit_plane(selected(cloud, piece));
    } catch (const Error&) {
      return best;  // a piece on one line
    }
    plane = fit.plane;
    best = ExtractedPlane{fit, std::move(piece)};
  }
  return best;
}

void remove_from(Indices& pool, const Indices& gone) {
  Indices kept;
  kept.reserve(pool.size());
  std::set_difference(pool.begin(), pool.end(), gone.begin(), gone.end(), std::back_inserter(kept));
  pool = std::move(kept);
}

/// Takes the plane's noisy fringe out of the pool as well, or it would be found as thin ghosts.
void remove_plane(const PointCloud& cloud,
                  Indices& pool,
                  const ExtractedPlane& plane,
                  const PlaneExtractionOptions& options) {
  remove_from(pool, plane.indices);
  Indices fringe = points_near(
      cloud, pool, plane.fit.plane, 2 * options.inlier_distance, options.max_normal_angle);
  const double reach = plane.fit.extent / 2;
  std::erase_if(fringe, [&](std::size_t i) {
    return (cloud.points[i].cast<double>() - plane.fit.centroid).norm() > reach;
  });
  remove_from(pool, fringe);
}

}  // namespace

void PlaneExtractionOptions::check() const {
  require(inlier_distance > 0 && std::isfinite(inlier_distance),
          "inlier_distance is ",
          inlier_distance,
          " m; give a length above 0");
  require(min_points >= 3, "min_points is ", min_points, "; a plane needs at least 3");
  require(max_planes >= 1, "max_planes is ", max_planes, "; give at least 1");
  require(iterations >= 1, "iterations is ", iterations, "; give at least 1");
  require(max_gap >= 0 && std::isfinite(max_gap),
          "max_gap is ",
          max_gap,
          " m; give a length, or 0 to take it from the points");
  require(max_normal_angle > 0 && max_normal_angle <= std::numbers::pi / 2,
          "max_normal_angle is ",
          max_normal_angle,
          " rad; give an angle above 0, at most pi/2");
}

std::vector<ExtractedPlane> extract_planes(const PointCloud& cloud,
                                           const PlaneExtractionOptions& options) {
  options.check();
  cloud.check();
  Indices pool;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.points[i].allFinite()) pool.push_back(i);
  }
  const Sampling sampling{point_spacing(cloud.points), sampling_distance(cloud).across};
  Random random(options.seed);
  std::vector<ExtractedPlane> planes;
  int failures = 0;
  while (planes.size() < static_cast<std::size_t>(options.max_planes) && failures < kFailures &&
         pool.size() >= options.min_points) {
    const auto candidate = ransac_plane(
        draw_sample(cloud, pool, random), {options.inlier_distance, options.iterations}, random);
    auto plane = candidate ? refine(cloud, pool, sampling, *candidate, options) : std::nullopt;
    if (!plane) {
      ++failures;
    } else if (plane->indices.size() < options.min_points) {
      ++failures;
      remove_from(pool, plane->indices);
    } else {
      remove_plane(cloud, pool, *plane, options);
      planes.push_back(std::move(*plane));
    }
  }
  std::stable_sort(planes.begin(), planes.end(), [](const auto& a, const auto& b) {
    return a.indices.size() > b.indices.size();
  });
  return planes;
}

}  // namespace facula
