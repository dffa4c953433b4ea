// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

namespace facula {

/// Gathers points and gives the normal of the plane that fits them best (least eigenvector of their
/// covariance). Sums run about a base near the points: far from the frame's origin the squares
/// would eat the digits.
class PlaneOfPoints {
 public:
  explicit PlaneOfPoints(const Eigen::Vector3f& base) : base_(base.cast<double>()) {}

  void add(const Eigen::Vector3f& point) {
    const Eigen::Vector3d d = point.cast<double>() - base_;
    sum_ += d;
    xx_ += d.x() * d.x();
    xy_ += d.x() * d.y();
    xz_ += d.x() * d.z();
    yy_ += d.y() * d.y();
    yz_ += d.y() * d.z();
    zz_ += d.z() * d.z();
    ++count_;
  }

  /// The unit normal on the side that `direction` points to. Where the points span no plane (fewer
  /// than three, all in one line, or all equal) it is `direction` itself, of unit length; zero when
  /// that is zero too.
  Eigen::Vector3f normal_towards(const Eigen::Vector3f& direction) const {
    Eigen::Matrix3d scatter;
    scatter << xx_, xy_, xz_, xy_, yy_, yz_, xz_, yz_, zz_;
    if (count_ >= 3) scatter -= sum_ * sum_.transpose() / count_;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(scatter);
    const Eigen::Vector3d& spread = solver.eigenvalues();
    constexpr double kFlat = 1e-10;  // of the longest axis' variance: 1e-5 of its length
    if (count_ < 3 || !(spread[1] > kFlat * spread[2])) return direction.stableNormalized();
    const Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>();
    return normal.dot(direction) < 0 ? Eigen::Vector3f(-normal) : normal;
  }

 private:
  Eigen::Vector3d base_;
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
  double count_ = 0;
};

}  // namespace facula
