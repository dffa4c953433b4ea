// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/reconstruct/measure/plane.hpp>

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Where and how a cloud is cut.
struct SectionOptions {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< the section's origin [m]
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< square to the cut; any length above 0
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();      ///< heights grow this way; not along normal
  double thickness = 0.005;                           ///< of the slice that is kept [m], above 0

  void check() const;
};

/// A slice of a cloud, laid flat.
struct ProfileSection {
  std::vector<Eigen::Vector2d> points;  ///< (across, height) [m], in the order of `across`
  std::vector<std::size_t> indices;     ///< of the cloud's points, in the same order
  std::vector<double> sigma;            ///< 1 standard deviation along the ray [m]; empty where the
                                        ///< cloud has none
};

/// The finite points within half the thickness of the cutting plane, carried onto it. Throws Error
/// when there is none.
ProfileSection cut_section(const PointCloud& cloud, const SectionOptions& options);

}  // namespace facula
