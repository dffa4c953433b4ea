// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/acquire/core/triangle_mesh.hpp>

#include <cstddef>
#include <limits>
#include <vector>

namespace facula {

struct DeviationOptions {
  /// Points farther away than this from the reference have no counterpart there [m], above 0.
  double max_distance = std::numeric_limits<double>::infinity();
  int num_threads = 0;  ///< 0 = all cores [1]

  void check() const;
};

/// How far points lie from a reference, one value per point.
struct Deviations {
  std::vector<double> values;  ///< [m]; NaN where a point is not finite or too far away
  bool has_sign = false;       ///< else all values are distances, 0 or more
  std::size_t too_far = 0;     ///< points without a counterpart within max_distance [1]
  std::size_t not_finite = 0;  ///< [1]
  std::size_t beyond_rim = 0;  ///< points nearest to the rim of an open mesh, whose sign says
                               ///< little [1]
};

/// Distance to the nearest place of the mesh's surface, positive on the side from which its
/// triangles run counter-clockwise: outside a closed mesh. The sign at edges and corners is that of
/// the angle-weighted normal, which is right there too (Baerentzen and Aanaes 2005). Throws Error
/// when the mesh has no surface.
Deviations deviations_from_mesh(const std::vector<Eigen::Vector3f>& points,
                                const TriangleMesh& mesh,
                                const DeviationOptions& options = {});

/// Distance to the nearest point of another cloud; where that cloud has normals, the signed
/// distance to the plane through that point, which the spacing of the points does not enlarge.
/// Throws Error when the reference has no finite point.
Deviations deviations_from_cloud(const std::vector<Eigen::Vector3f>& points,
                                 const PointCloud& reference,
                                 const DeviationOptions& options = {});

/// Figures over deviations; values that are NaN are left out.
struct DeviationStatistics {
  std::size_t count = 0;          ///< [1]
  double mean = 0;                ///< signed [m]
  double standard_deviation = 0;  ///< about the mean, n - 1 [m]
  double median = 0;              ///< signed [m]
  double rms = 0;                 ///< about 0 [m]
  double median_absolute = 0;     ///< half of the distances lie at or below [m]
  double p95_absolute = 0;        ///< 95 of 100 distances lie at or below [m]
  double max_absolute = 0;        ///< [m]
  double least = 0;               ///< [m]
  double most = 0;                ///< [m]
};

/// All zeros for no values.
DeviationStatistics deviation_statistics(const std::vector<double>& values);

/// How many values lie in each of equal bins from low to high.
struct DeviationBins {
  double low = 0;                   ///< [m]
  double high = 0;                  ///< [m]
  std::vector<std::size_t> counts;  ///< per bin [1]
  std::size_t below = 0;            ///< values below low [1]
  std::size_t above = 0;            ///< values above high [1]
};

/// The size of deviation up to which nearly all lie: 199 in 200, or 5 times that of 2 in 3 where a
/// few strays would stretch it [m]. 0 for no values.
double typical_reach(const std::vector<double>& values);

/// `count` bins, at least 1, over the values within typical_reach() of 0; from 0 on where no value
/// is below.
DeviationBins bin_deviations(const std::vector<double>& values, std::size_t count);

}  // namespace facula
