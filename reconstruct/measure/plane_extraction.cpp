// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/random.hpp>
#include <facula/reconstruct/measure/plane.hpp>
#include <facula/reconstruct/measure/plane_pool.hpp>
#include <facula/reconstruct/measure/ransac_plane.hpp>
#include <facula/reconstruct/measure/surface_noise.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace facula {
namespace {

constexpr std::size_t kSample = 12000;  // points among which RANSAC counts [1]
constexpr int kFailures = 8;            // candidates in a row that are no planes end the search
constexpr double kLeastInlier = 1e-6;   // [m]

/// Up to kSample points of the pool, drawn without putting back (Fisher and Yates).
std::vector<Eigen::Vector3f> draw_sample(const PointCloud& cloud,
                                         std::vector<std::size_t> pool,
                                         Random& random) {
  const std::size_t count = std::min(kSample, pool.size());
  std::vector<Eigen::Vector3f> sample;
  sample.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::swap(pool[i], pool[i + random.below(pool.size() - i)]);
    sample.push_back(cloud.points[pool[i]]);
  }
  return sample;
}

}  // namespace

void PlaneExtractionOptions::check() const {
  const double inlier = inlier_distance.value_or(1);
  require(inlier > 0 && std::isfinite(inlier),
          "inlier_distance is ",
          inlier,
          " m; give a length above 0, or none to take it from the points");
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
  require(max_bend > 0, "max_bend is ", max_bend, " rad; give an angle above 0");
  require(num_threads >= 0, "num_threads is ", num_threads, "; give 0 (all cores) or more");
}

double default_inlier_distance(const PointCloud& cloud) {
  return std::max(kLeastInlier, 4 * surface_noise(cloud));
}

std::vector<ExtractedPlane> extract_planes(const PointCloud& cloud,
                                           const PlaneExtractionOptions& options) {
  options.check();
  cloud.check();
  PlanePool pool(cloud, options);
  Random random(options.seed);
  int failures = 0;
  while (!pool.full() && failures < kFailures) {
    const auto candidate = ransac_plane(draw_sample(cloud, pool.left(), random),
                                        {pool.inlier_distance(), options.iterations},
                                        random);
    failures = candidate && pool.take(*candidate) ? 0 : failures + 1;
  }
  return std::move(pool).planes();
}

}  // namespace facula
