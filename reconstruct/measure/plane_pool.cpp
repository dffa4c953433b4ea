// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/known_sigma.hpp>
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/filter/nearest_neighbours.hpp>
#include <facula/reconstruct/filter/point_spacing.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>
#include <facula/reconstruct/measure/largest_piece.hpp>
#include <facula/reconstruct/measure/plane_bend.hpp>
#include <facula/reconstruct/measure/plane_pool.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <Eigen/Eigenvalues>

namespace facula {
namespace {

using Indices = std::vector<std::size_t>;

constexpr int kRefinements = 8;
constexpr double kSigmas = 3;             // along the normal, that points lie from their plane
constexpr double kGrowth = 1.01;          // a round that adds less was the last
constexpr double kPlainShare = 0.5;       // of the variance that a bend must explain
constexpr std::size_t kSpacings = 20000;  // points whose spacing is measured [1]
constexpr std::size_t kPointsAChunk = 16384;

/// Distance to the nearest other point, for every n-th point.
std::vector<float> some_spacings(const std::vector<Eigen::Vector3f>& points,
                                 const NearestNeighbours& tree,
                                 int num_threads) {
  std::vector<float> spacing(points.size(), std::numeric_limits<float>::quiet_NaN());
  const std::size_t count = std::min(kSpacings, points.size());
  const auto measure = [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t i = n * points.size() / count;
      if (!points[i].allFinite()) continue;
      const auto nearest = tree.nearest(points[i], 2);
      if (nearest.size() == 2) spacing[i] = std::sqrt(nearest[1].squared_distance);
    }
  };
  parallel_for(count, measure, {.num_threads = num_threads, .chunk = 256});
  return spacing;
}

/// Least-squares plane of the points; nothing when they lie on a line.
std::optional<Plane> principal_plane(const PointCloud& cloud, const Indices& indices) {
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
  for (const std::size_t i : indices) centroid += cloud.points[i].cast<double>();
  centroid /= static_cast<double>(indices.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const std::size_t i : indices) {
    const Eigen::Vector3d d = cloud.points[i].cast<double>() - centroid;
    scatter += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  if (!(solver.eigenvalues()(1) > 1e-8 * solver.eigenvalues()(2))) return {};
  const Eigen::Vector3d normal = solver.eigenvectors().col(0).normalized();
  return Plane{normal, normal.dot(centroid)};
}

}  // namespace

PlanePool::PlanePool(const PointCloud& cloud, const PlaneExtractionOptions& options)
    : cloud_(cloud),
      options_(options),
      inlier_distance_(options.inlier_distance ? *options.inlier_distance
                                               : default_inlier_distance(cloud)) {
  const NearestNeighbours tree(cloud.points, options.num_threads);
  spacing_ = some_spacings(cloud.points, tree, options.num_threads);
  across_ = sampling_distance(cloud, tree).across;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.points[i].allFinite()) left_.push_back(i);
  }
}

double PlanePool::reach_of(std::size_t point, const Eigen::Vector3d& normal) const {
  const bool widen = options_.widen_by_sigma || !options_.inlier_distance;
  if (!widen || cloud_.sigma.empty()) return inlier_distance_;
  if (!is_known_sigma(cloud_.sigma[point])) return inlier_distance_;
  const double sigma = kSigmas * static_cast<double>(cloud_.sigma[point]);
  if (sigma <= inlier_distance_) return inlier_distance_;
  Eigen::Vector3d ray = cloud_.points[point].cast<double>();
  if (!cloud_.sensor_origin.empty()) ray -= cloud_.sensor_origin[point].cast<double>();
  return std::max(inlier_distance_, sigma * std::abs(ray.normalized().dot(normal)));
}

Indices PlanePool::points_near(const Plane& plane, double widening) const {
  const double min_cosine = std::cos(options_.max_normal_angle);
  const auto search = [&](std::size_t begin, std::size_t end) {
    Indices near;
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t i = left_[n];
      const double away = std::abs(plane.signed_distance(cloud_.points[i].cast<double>()));
      if (!(away <= widening * reach_of(i, plane.normal))) continue;
      if (!cloud_.normals.empty()) {
        const Eigen::Vector3d normal = cloud_.normals[i].cast<double>();
        if (std::abs(normal.dot(plane.normal)) < min_cosine) continue;
      }
      near.push_back(i);
    }
    return near;
  };
  const auto join = [](Indices first, const Indices& more) {
    first.insert(first.end(), more.begin(), more.end());
    return first;
  };
  return parallel_reduce(left_.size(),
                         Indices{},
                         search,
                         join,
                         {.num_threads = options_.num_threads, .chunk = kPointsAChunk});
}

double PlanePool::gap_of(const Indices& points) const {
  if (options_.max_gap > 0) return options_.max_gap;
  std::vector<float> here;
  for (const std::size_t i : points) {
    if (!std::isnan(spacing_[i])) here.push_back(spacing_[i]);
  }
  return std::max({8 * quantile(std::move(here), 0.95), 3 * across_, 2 * inlier_distance_});
}

/// Gathers, keeps the largest piece and fits in turn until the plane takes in no more points.
std::optional<Indices> PlanePool::refined(Plane plane) const {
  std::optional<Indices> best;
  for (int round = 0; round < kRefinements; ++round) {
    const Indices near = points_near(plane, 1);
    if (near.size() < 3) return best;
    Indices piece = largest_piece(cloud_, near, plane, gap_of(near));
    if (piece.size() < 3 || (best && piece.size() <= best->size())) return best;
    const auto fitted = principal_plane(cloud_, piece);
    if (!fitted) return best;
    const bool last =
        best && static_cast<double>(piece.size()) < kGrowth * static_cast<double>(best->size());
    best = std::move(piece);
    if (last) return best;
    plane = *fitted;
  }
  return best;
}

void PlanePool::remove(const Indices& gone) {
  Indices kept;
  kept.reserve(left_.size());
  std::set_difference(
      left_.begin(), left_.end(), gone.begin(), gone.end(), std::back_inserter(kept));
  left_ = std::move(kept);
}

/// The plane's noisy fringe would be found as thin ghosts.
void PlanePool::remove_fringe(const PlaneFit& fit) {
  Indices fringe = points_near(fit.plane, 2);
  const double reach = fit.extent / 2;
  std::erase_if(fringe, [&](std::size_t i) {
    return (cloud_.points[i].cast<double>() - fit.centroid).norm() > reach;
  });
  remove(fringe);
}

bool PlanePool::take(const Plane& candidate) {
  auto indices = refined(candidate);
  if (!indices) return false;
  remove(*indices);
  if (indices->size() < options_.min_points) return false;
  ExtractedPlane plane{fit_plane(cloud_, *indices), std::move(*indices)};
  const PlaneBend bend = bend_of(cloud_, plane.indices, plane.fit.plane);
  if (bend.angle > options_.max_bend && bend.share > kPlainShare) return false;
  remove_fringe(plane.fit);
  planes_.push_back(std::move(plane));
  return true;
}

bool PlanePool::full() const {
  return planes_.size() >= static_cast<std::size_t>(options_.max_planes) ||
         left_.size() < options_.min_points;
}

std::vector<ExtractedPlane> PlanePool::planes() && {
  std::stable_sort(planes_.begin(), planes_.end(), [](const auto& a, const auto& b) {
    return a.indices.size() > b.indices.size();
  });
  return std::move(planes_);
}

}  // namespace facula
