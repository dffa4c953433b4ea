// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/measure/plane.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace facula {

/// The points that belong to no plane yet, and what becomes of a candidate: the common end of every
/// search for planes.
class PlanePool {
 public:
  /// The cloud and the options must outlive the pool.
  PlanePool(const PointCloud& cloud, const PlaneExtractionOptions& options);

  /// Points not taken yet, ascending.
  const std::vector<std::size_t>& left() const { return left_; }
  double inlier_distance() const { return inlier_distance_; }

  /// Farthest from a plane of this normal that this point of it may lie [m].
  double reach_of(std::size_t point, const Eigen::Vector3d& normal) const;

  /// Gathers the candidate's points, refines it and keeps it when it is large and flat enough.
  /// Either way its points leave the pool. False when it was not kept.
  bool take(const Plane& candidate);

  bool full() const;

  /// What was kept, largest first.
  std::vector<ExtractedPlane> planes() &&;

 private:
  std::vector<std::size_t> points_near(const Plane& plane, double widening) const;
  double gap_of(const std::vector<std::size_t>& points) const;
  std::optional<std::vector<std::size_t>> refined(Plane plane) const;
  void remove(const std::vector<std::size_t>& gone);
  void remove_fringe(const PlaneFit& fit);

  const PointCloud& cloud_;
  const PlaneExtractionOptions& options_;
  double inlier_distance_ = 0;
  std::vector<std::size_t> left_;
  std::vector<float> spacing_;  ///< of some points, NaN elsewhere [m]
  double across_ = 0;           ///< from stripe to stripe [m]
  std::vector<ExtractedPlane> planes_;
};

}  // namespace facula
