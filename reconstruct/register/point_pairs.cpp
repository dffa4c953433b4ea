// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/parallel.hpp>
#include <facula/reconstruct/register/point_pairs.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace facula {
namespace {

constexpr double kLeastCosine = 0.2;     // a grazing ray does not make a point exact
constexpr double kVarianceRatio = 1e-3;  // across to along the surface (Segal et al. 2009)
constexpr double kLeastVarianceRatio = 1e-5;

/// Standard deviation of a point across its surface: the part of sigma along the ray [m].
double sigma_across(const PointCloud& cloud, std::size_t i, const Eigen::Vector3d& normal) {
  const double sigma = cloud.sigma[i];
  if (cloud.sensor_origin.empty()) return sigma;
  const Eigen::Vector3d ray = (cloud.points[i] - cloud.sensor_origin[i]).cast<double>();
  const double length = ray.norm();
  if (!(length > 0)) return sigma;
  return sigma * std::max(std::abs(ray.dot(normal)) / length, kLeastCosine);
}

class Matcher {
 public:
  Matcher(const PairSearch& search, const RigidTransform& target_from_source)
      : search_(search),
        source_(search.source.cloud),
        target_(search.target.cloud),
        rotation_(target_from_source.rotation.toRotationMatrix()),
        translation_(target_from_source.translation),
        squared_bound_(search.max_distance * search.max_distance),
        min_cosine_(std::cos(search.options.max_normal_angle)),
        known_sigma_(!source_.sigma.empty() && !target_.sigma.empty()),
        along_(std::pow(search.source.voxel / 2, 2)),
        target_along_(std::pow(search.target.voxel / 2, 2)) {}

  bool match(std::size_t i, PointPair& pair) const {
    pair.point = rotation_ * source_.points[i].cast<double>() + translation_;
    const auto nearest = search_.target.tree.nearest(pair.point.cast<float>());
    if (!(double(nearest.squared_distance) <= squared_bound_)) return false;
    pair.target_normal = target_.normals[nearest.index].cast<double>();
    const Eigen::Vector3d own_normal = source_.normals[i].cast<double>();
    pair.source_normal = rotation_ * own_normal;
    if (!agree(pair)) return false;
    pair.source = static_cast<std::uint32_t>(i);
    pair.target = static_cast<std::uint32_t>(nearest.index);
    pair.offset = pair.point - target_.points[nearest.index].cast<double>();
    pair.distance = pair.offset.norm();
    weigh(pair, own_normal);
    return true;
  }

 private:
  /// Turns the source normal to the target's side where sides are unknown.
  bool agree(PointPair& pair) const {
    double cosine = pair.source_normal.dot(pair.target_normal);
    if (!search_.sided && cosine < 0) {
      pair.source_normal = -pair.source_normal;
      cosine = -cosine;
    }
    return cosine >= min_cosine_;  // false too where a normal is unknown (zero)
  }

  void weigh(PointPair& pair, const Eigen::Vector3d& own_normal) const {
    double source_across = kVarianceRatio * along_;
    double target_across = kVarianceRatio * target_along_;
    if (known_sigma_) {
      source_across = std::pow(sigma_across(source_, pair.source, own_normal), 2);
      target_across = std::pow(sigma_across(target_, pair.target, pair.target_normal), 2);
      source_across = std::max(source_across, kLeastVarianceRatio * along_);
      target_across = std::max(target_across, kLeastVarianceRatio * target_along_);
    }
    const bool plane = search_.options.method == PairMethod::kPointToPlane;
    const Eigen::Vector3d normal =
        plane ? pair.target_normal
              : Eigen::Vector3d((pair.source_normal + pair.target_normal).normalized());
    const double variance = source_across + target_across;
    if (plane) {
      pair.weight = normal * normal.transpose() / variance;
    } else {
      // Segal et al. 2009, section III: each point spreads along its own tangent plane.
      const Eigen::Matrix3d spread =
          (along_ + target_along_) * Eigen::Matrix3d::Identity() -
          (along_ - source_across) * pair.source_normal * pair.source_normal.transpose() -
          (target_along_ - target_across) * pair.target_normal * pair.target_normal.transpose();
      pair.weight = spread.inverse();
    }
    pair.plane_distance = normal.dot(pair.offset);
    pair.residual = pair.plane_distance / std::sqrt(variance);
  }

  const PairSearch& search_;
  const PointCloud& source_;
  const PointCloud& target_;
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d translation_;
  double squared_bound_;
  double min_cosine_;
  bool known_sigma_;
  double along_;         // variance of a point along its surface [m^2]
  double target_along_;  // the same of the target [m^2]
};

}  // namespace

std::vector<PointPair> find_pairs(const PairSearch& search,
                                  const RigidTransform& target_from_source) {
  const Matcher matcher(search, target_from_source);
  const std::size_t count = search.source.cloud.size();
  std::vector<PointPair> found(count);
  std::vector<char> is_pair(count, 0);
  const auto body = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) is_pair[i] = matcher.match(i, found[i]) ? 1 : 0;
  };
  parallel_for(count, body, {.num_threads = search.options.num_threads, .chunk = 512});
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (is_pair[i] == 0) continue;
    if (kept != i) found[kept] = found[i];
    ++kept;
  }
  found.resize(kept);
  return found;
}

}  // namespace facula
