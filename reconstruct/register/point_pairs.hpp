// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/reconstruct/register/pair_registration.hpp>

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A source point and the target point nearest to it, in the target frame.
struct PointPair {
  std::uint32_t source = 0;       ///< index in the source level's cloud [1]
  std::uint32_t target = 0;       ///< index in the target level's cloud [1]
  double distance = 0;            ///< between the two points [m]
  double residual = 0;            ///< of `offset` along `normal`, in standard deviations [1]
  double plane_distance = 0;      ///< the same [m]
  Eigen::Vector3d point;          ///< the source point [m]
  Eigen::Vector3d offset;         ///< source point - target point [m]
  Eigen::Vector3d source_normal;  ///< unit, on the target normal's side [1]
  Eigen::Vector3d target_normal;  ///< unit [1]
  Eigen::Vector3d normal;         ///< of the surface: the target's, or the mean of both [1]
  Eigen::Matrix3d weight;         ///< inverse covariance of `offset` [1/m^2]
};

/// Finds the pairs of two levels for one pose after the other. It remembers each point's nearest
/// two target points: while the point has moved less than the gap between them, the nearer one is
/// still the nearest, and no search is needed. The pairs do not depend on what it remembers.
class PairFinder {
 public:
  /// `sided`: the two normals of a pair must face the same way. The arguments must outlive it.
  PairFinder(const PyramidLevel& source,
             const PyramidLevel& target,
             bool sided,
             const PairOptions& options);

  /// One pair for every source point whose nearest target point lies within `max_distance` [m] and
  /// has a normal that agrees, in the order of the source points.
  std::vector<PointPair> find(const RigidTransform& target_from_source, double max_distance);

 private:
  /// What a point is worth.
  struct PointQuality {
    float across = 0;  ///< variance across the surface [m^2]
    float doubt = 1;   ///< 1 / confidence, 1 or more [1]
  };
  static std::vector<PointQuality> qualities(const PyramidLevel& level, bool use_sigma);

  struct Found {
    Eigen::Vector3f query{0, 0, 0};  ///< where the search was made [m]
    std::uint32_t nearest = 0;       ///< [1]
    float distance = -1;             ///< to the nearest, negative before any search [m]
    float second = 0;                ///< to the second nearest [m]
  };

  bool match(std::size_t i, const Eigen::Matrix3d& rotation, double bound, PointPair& pair);
  bool find_nearest(const Eigen::Vector3f& query, float bound, Found& found) const;
  bool normals_agree(PointPair& pair) const;
  void weigh(PointPair& pair) const;

  const PyramidLevel& source_;
  const PyramidLevel& target_;
  const PairOptions& options_;
  bool sided_;
  double min_cosine_;
  std::vector<PointQuality> source_quality_;
  std::vector<PointQuality> target_quality_;
  double source_along_;  ///< variance of the points along their surface [m^2]
  double target_along_;
  std::vector<Found> found_;
};

}  // namespace facula
