// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/sheet_fit.hpp>
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/core/median.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace facula {
namespace {

/// Residual of a point and its derivatives.
struct Linearised {
  double residual = 0;             ///< off the sheet [m]
  Eigen::VectorXd slopes;          ///< by turn a, turn b, distance [m], bow
  double variance = 0;             ///< of the pixel's noise [m^2]
  Eigen::RowVector3d pose_slopes;  ///< by the three errors of the board
};

LaserPlane moved_plane(const LaserPlane& plane, const Eigen::VectorXd& step) {
  const TangentBasis basis = tangent_basis(plane.normal);
  LaserPlane moved = plane;
  moved.normal = (plane.normal + step[0] * basis.a + step[1] * basis.b).normalized();
  moved.distance += step[2];
  if (step.size() > 3) moved.bow += step[3];
  return moved;
}

Linearised linearise(const LaserPlane& plane, const SheetPoint& point, bool bow) {
  Linearised l;
  l.residual = plane.sheet_distance(point.x);
  l.slopes.resize(bow ? 4 : 3);
  for (int k = 0; k < l.slopes.size(); ++k) {
    constexpr double kStep = 1e-6;
    Eigen::VectorXd step = Eigen::VectorXd::Zero(l.slopes.size());
    step[k] = kStep;
    const double ahead = moved_plane(plane, step).sheet_distance(point.x);
    l.slopes[k] = (ahead - moved_plane(plane, -step).sheet_distance(point.x)) / (2 * kStep);
  }
  Eigen::RowVector3d gradient;
  for (int k = 0; k < 3; ++k) {
    constexpr double kStep = 1e-6;
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(k);
    gradient[k] =
        (plane.sheet_distance(point.x + d) - plane.sheet_distance(point.x - d)) / (2 * kStep);
  }
  l.variance = std::pow(gradient.dot(point.per_pixel) * point.sigma, 2);
  l.pose_slopes = gradient * point.per_pose;
  return l;
}

/// Tukey's weight of a residual in units of its sigma.
double tukey(double z, double limit) {
  const double share = z / (2 * limit);
  return std::abs(share) >= 1 ? 0 : std::pow(1 - share * share, 2);
}

struct Normals {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd vector;
};

/// Adds one view: the errors of its board (prior 0 with its covariance) are eliminated by the Schur
/// complement, so that its points count as much as the pose is known and no more.
void add_view(const std::vector<Linearised>& points,
              const std::vector<double>& weights,
              const Eigen::Matrix3d& pose_covariance,
              Normals& normals) {
  const Eigen::Index n = normals.vector.size();
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(n, 3);
  Eigen::Matrix3d inner = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Linearised& p = points[i];
    const double w = weights[i];
    normals.matrix += w * p.slopes * p.slopes.transpose();
    normals.vector -= w * p.slopes * p.residual;
    cross += w * p.slopes * p.pose_slopes;
    inner += w * p.pose_slopes.transpose() * p.pose_slopes;
    right -= w * p.pose_slopes.transpose() * p.residual;
  }
  // (P^-1 + J' W J)^-1 = P (I + J' W J P)^-1 holds for singular P too.
  const Eigen::Matrix3d spread =
      pose_covariance * (Eigen::Matrix3d::Identity() + inner * pose_covariance).inverse();
  normals.matrix -= cross * spread * cross.transpose();
  normals.vector -= cross * spread * right;
}

/// Errors of the board that explain the residuals best, given the prior.
Eigen::Vector3d board_error(const std::vector<Linearised>& points,
                            const std::vector<double>& weights,
                            const Eigen::Matrix3d& pose_covariance) {
  Eigen::Matrix3d inner = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    inner += weights[i] * points[i].pose_slopes.transpose() * points[i].pose_slopes;
    right += weights[i] * points[i].pose_slopes.transpose() * points[i].residual;
  }
  return pose_covariance * (Eigen::Matrix3d::Identity() + inner * pose_covariance).inverse() *
         right;
}

/// One robust iteration: weights from the residuals as they are.
SheetFit iterate(const std::vector<SheetView>& views,
                 const SheetFit& from,
                 const LaserCalibrationOptions& options) {
  const int n = options.bow ? 4 : 3;
  Normals normals{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  std::vector<double> off;
  std::size_t outliers = 0;
  const double scale = std::sqrt(from.variance_factor);
  for (const SheetView& view : views) {
    std::vector<Linearised> points;
    std::vector<double> weights;
    for (const SheetPoint& p : view.points) {
      points.push_back(linearise(from.plane, p, options.bow));
      weights.push_back(1 / points.back().variance);
    }
    const Eigen::Vector3d error = board_error(points, weights, view.pose_covariance);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double z = (points[i].residual - points[i].pose_slopes.dot(error.transpose())) /
                       std::sqrt(points[i].variance);
      off.push_back(std::abs(z));
      outliers += std::abs(z) > options.outlier_sigmas * scale ? 1U : 0U;
      weights[i] *= tukey(z / scale, options.outlier_sigmas);
    }
    add_view(points, weights, view.pose_covariance, normals);
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(normals.matrix);
  SheetFit fit;
  const Eigen::VectorXd step = solver.solve(normals.vector);
  require(solver.info() == Eigen::Success && step.allFinite(),
          "the laser lines do not determine a sheet; hold the board at several distances");
  fit.plane = moved_plane(from.plane, step);
  fit.outlier_share = static_cast<double>(outliers) / static_cast<double>(off.size());
  const double robust = 1.4826 * median(off);
  fit.variance_factor = std::max(robust * robust, 1e-6);
  fit.covariance =
      solver.solve(Eigen::MatrixXd::Identity(n, n)) * std::max(1.0, fit.variance_factor);
  return fit;
}

}  // namespace

SheetFit fit_sheet(const std::vector<SheetView>& views, const LaserCalibrationOptions& options) {
  SheetFit fit;
  fit.plane = plane_through(views).plane;
  fit.variance_factor = 1e12;  // the first rounds take every point
  for (int round = 0; round < 30; ++round) {
    const LaserPlane before = fit.plane;
    fit = iterate(views, fit, options);
    const double change = (fit.plane.normal - before.normal).norm() +
                          std::abs(fit.plane.distance - before.distance) +
                          std::abs(fit.plane.bow - before.bow);
    if (round > 3 && change < 1e-10) break;
  }
  return fit;
}

}  // namespace facula
