// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// A surface with a few parameters, as the fit moves it.
class PrimitiveModel {
 public:
  virtual ~PrimitiveModel() = default;

  virtual int parameters() const = 0;

  /// Signed distance of x from the surface [m]; `normal` receives the surface's unit normal there
  /// and `gradient` the distance's derivatives by the parameters.
  virtual double distance(const Eigen::Vector3d& x,
                          Eigen::Vector3d& normal,
                          Eigen::VectorXd& gradient) const = 0;

  /// Adds to the parameters.
  virtual void move(const Eigen::VectorXd& step) = 0;

  /// Takes the last move back.
  virtual void undo() = 0;
};

struct PrimitiveFitOptions {
  bool weigh_by_sigma = true;  ///< as PlaneFitOptions
  int max_iterations = 100;    ///< [1]
};

/// How well points lie on a fitted surface.
struct PrimitiveQuality {
  std::size_t points = 0;              ///< [1]
  double rms = 0;                      ///< of the distances, n - parameters degrees of freedom [m]
  double peak_to_valley = 0;           ///< largest minus smallest distance [m]
  double chi_squared = 0;              ///< sum of (distance / sigma)^2, 0 without sigma [1]
  std::size_t degrees_of_freedom = 0;  ///< [1]
  double unexplained = 0;              ///< of the distances by the sigmas [m]
  int iterations = 0;                  ///< [1]
  Eigen::MatrixXd covariance;          ///< of the parameters: from the points' sigma and what it
                                       ///< leaves unexplained; from rms without, NaN where no
                                       ///< degree is left to tell it
};

/// Geometric least squares by Levenberg and Marquardt's method from where the model stands. Throws
/// Error for fewer points than parameters, points that leave a parameter undecided, and when no end
/// is reached.
PrimitiveQuality fit_primitive(const PointCloud& cloud,
                               const std::vector<std::size_t>& indices,
                               PrimitiveModel& model,
                               const PrimitiveFitOptions& options = {});

}  // namespace facula
