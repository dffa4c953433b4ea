// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_residuals.hpp>
#include <facula/acquire/calibrate/joint_view.hpp>

#include <Eigen/Core>
#include <ceres/ceres.h>

namespace facula {

/// A board point off its projection along x and y, in sigmas. Parameters: camera 9, pose 6, scale 1
/// and of placed views axis 4, position 1. The view must stand at the same parameters.
class JointPointCost final : public ceres::CostFunction {
 public:
  JointPointCost(const JointState& state,
                 const JointSight& sight,
                 const JointPoint& point,
                 double sigma,
                 const JointViewPose& view)
      : camera_(state.rig.camera),
        size_(state.scales[sight.board]),
        point_(point),
        sigma_(sigma),
        view_(view) {
    set_num_residuals(2);
    *mutable_parameter_block_sizes() = {9, 6, 1};
    if (sight.placed) *mutable_parameter_block_sizes() = {9, 6, 1, 4, 1};
  }

  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override {
    const Eigen::Vector3d b = (size_ + p[2][0]) * point_.on_board;
    const Eigen::Vector3d x = view_.at.leftCols<3>() * b + view_.at.col(3);
    if (!(x.z() > 1e-6)) return false;
    const Eigen::Vector2d n = x.head<2>() / x.z();
    const JointPixel pixel = joint_pixel(camera_, p[0], n);
    Eigen::Map<Eigen::Vector2d>(residuals, 2) = (pixel.at - point_.pixel) / sigma_;
    if (jacobians == nullptr) return true;
    Eigen::Matrix<double, 2, 3> by_x;
    by_x.leftCols<2>() = pixel.by_normalized / (x.z() * sigma_);
    by_x.col(2) = -by_x.leftCols<2>() * n;
    if (jacobians[0] != nullptr) put<9>(jacobians[0], pixel.by_camera / sigma_);
    if (jacobians[2] != nullptr) {
      put<1>(jacobians[2], by_x * (view_.at.leftCols<3>() * point_.on_board));
    }
    const Eigen::Matrix<double, 3, 11> x_by =
        b.x() * view_.by.middleRows<3>(0) + b.y() * view_.by.middleRows<3>(3) +
        b.z() * view_.by.middleRows<3>(6) + view_.by.middleRows<3>(9);
    if (jacobians[1] != nullptr) put<6>(jacobians[1], by_x * x_by.leftCols<6>());
    if (parameter_block_sizes().size() == 3) return true;
    if (jacobians[3] != nullptr) put<4>(jacobians[3], by_x * x_by.middleCols<4>(6));
    if (jacobians[4] != nullptr) put<1>(jacobians[4], by_x * x_by.col(10));
    return true;
  }

 private:
  template <int kCount, typename Matrix>
  static void put(double* to, const Matrix& jacobian) {
    for (int r = 0; r < 2; ++r) {
      Eigen::Map<Eigen::Matrix<double, kCount, 1>>(to + r * kCount) = jacobian.row(r).transpose();
    }
  }

  const Camera& camera_;
  double size_;
  const JointPoint& point_;
  double sigma_;
  const JointViewPose& view_;
};

/// What a line pixel keeps of the state at the start.
struct JointLineBase {
  const Camera& camera;
  const LaserPlane& plane;
  Eigen::Vector2d normalized;  ///< of the pixel
  Eigen::Matrix2d back;        ///< from pixels to normalized
  double metres_sigma;         ///< of the distance off the sheet
  bool bends;                  ///< whether the sheet is a cone
};

/// How far the ray of a line pixel meets the board off the sheet, in sigmas. Parameters: camera 9,
/// sheet 4, pose 6 and of placed views axis 4, position 1. View and sheet must stand at these.
class JointLineCost final : public ceres::CostFunction {
 public:
  JointLineCost(const JointLineBase& base,
                const Eigen::Vector2d& pixel,
                bool placed,
                const JointViewPose& view,
                const JointSheet& sheet)
      : base_(base), pixel_(pixel), view_(view), sheet_(sheet) {
    set_num_residuals(1);
    *mutable_parameter_block_sizes() = {9, 4, 6};
    if (placed) *mutable_parameter_block_sizes() = {9, 4, 6, 4, 1};
  }

  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override {
    // One Newton step from the undistorted pixel at the start: exact to first order.
    const JointPixel start = joint_pixel(base_.camera, p[0], base_.normalized);
    const Eigen::Vector2d n = base_.normalized - base_.back * (start.at - pixel_);
    const Eigen::Vector3d ray(n.x(), n.y(), 1);
    const auto normal = view_.at.col(2);
    const auto through = view_.at.col(3);
    const double approach = normal.dot(ray);
    if (approach == 0) return false;
    const double depth = normal.dot(through) / approach;
    const Eigen::Vector3d x = depth * ray;
    Eigen::Vector3d by_x;
    Eigen::Vector4d by_sheet;
    residuals[0] = off_sheet(p[1], x, by_x, by_sheet) / base_.metres_sigma;
    if (jacobians == nullptr) return true;
    by_x /= base_.metres_sigma;
    const double by_depth = by_x.dot(ray);
    if (jacobians[0] != nullptr) {
      // The ray moves by `dn` and its depth by -depth normal.dn / approach.
      const Eigen::Vector2d by_n =
          depth * (by_x.head<2>() - by_depth / approach * normal.head<2>());
      Eigen::Map<Eigen::Matrix<double, 1, 9>>(jacobians[0], 9) =
          -(by_n.transpose() * base_.back) * start.by_camera;
    }
    if (jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Vector4d>(jacobians[1], 4) = by_sheet / base_.metres_sigma;
    }
    const Eigen::Matrix<double, 1, 11> by_view =
        by_depth / approach *
        ((through - x).transpose() * view_.by.middleRows<3>(6) +
         normal.transpose() * view_.by.middleRows<3>(9));
    if (jacobians[2] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 1, 6>>(jacobians[2], 6) = by_view.leftCols<6>();
    }
    if (parameter_block_sizes().size() == 3) return true;
    if (jacobians[3] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, 1, 4>>(jacobians[3], 4) = by_view.middleCols<4>(6);
    }
    if (jacobians[4] != nullptr) jacobians[4][0] = by_view[10];
    return true;
  }

 private:
  /// Distance of x off the sheet and its derivatives [m].
  double off_sheet(const double* change,
                   const Eigen::Vector3d& x,
                   Eigen::Vector3d& by_x,
                   Eigen::Vector4d& by_sheet) const {
    if (!base_.bends) {
      by_x = sheet_.at.head<3>();
      by_sheet = sheet_.by.topRows<3>().transpose() * x - sheet_.by.row(3).transpose();
      return by_x.dot(x) - sheet_.at[3];
    }
    using Jet = ceres::Jet<double, 7>;
    Vector3T<Jet> point;
    for (int k = 0; k < 3; ++k) point[k] = {x[k], k};
    Jet d[4];
    for (int k = 0; k < 4; ++k) d[k] = {change[k], 3 + k};
    const Jet off = distance_off_sheet<Jet>(base_.plane, d, point, true);
    by_x = off.v.head<3>();
    by_sheet = off.v.tail<4>();
    return off.a;
  }

  JointLineBase base_;
  Eigen::Vector2d pixel_;
  const JointViewPose& view_;
  const JointSheet& sheet_;
};

/// A number that is known to be 0 within sigma; `offset`: from its known value at the start.
class JointPriorCost final : public ceres::CostFunction {
 public:
  JointPriorCost(double offset, double sigma) : offset_(offset), sigma_(sigma) {
    set_num_residuals(1);
    *mutable_parameter_block_sizes() = {1};
  }
  bool Evaluate(double const* const* p, double* residuals, double** jacobians) const override {
    residuals[0] = (offset_ + p[0][0]) / sigma_;
    if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = 1 / sigma_;
    return true;
  }

 private:
  double offset_;
  double sigma_;
};

}  // namespace facula
