// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/register/scan_motion.hpp>

#include <cmath>

namespace facula {
namespace {

constexpr double kSigmas = 5;

/// The turn that brings the source's axis, as the pose has it, onto the target's.
Eigen::Quaterniond lean(const Eigen::Vector3d& axis, const RigidTransform& target_from_source) {
  return Eigen::Quaterniond::FromTwoVectors(target_from_source.rotation * axis, axis);
}

double angle_of(const Eigen::Quaterniond& turn) {
  return 2 * std::atan2(turn.vec().norm(), std::abs(turn.w()));
}

}  // namespace

void ScanMotion::check() const {
  require(axis.allFinite() && axis.norm() > 0,
          "the axis is (",
          axis.transpose(),
          "); give a direction");
  require(angle_sigma > 0 && std::isfinite(angle_sigma),
          "angle_sigma is ",
          angle_sigma,
          " rad; give an angle above 0");
  require(height_sigma > 0 && std::isfinite(height_sigma),
          "height_sigma is ",
          height_sigma,
          " m; give a length above 0");
}

bool ScanMotion::allows(const RigidTransform& target_from_source) const {
  if (kind == ScanStand::kFree) return true;
  const Eigen::Vector3d up = axis.normalized();
  if (angle_of(lean(up, target_from_source)) > kSigmas * angle_sigma) return false;
  return kind == ScanStand::kUpright ||
         std::abs(up.dot(target_from_source.translation)) <= kSigmas * height_sigma;
}

PoseEdge ScanMotion::as_edge(std::size_t from,
                             std::size_t to,
                             const RigidTransform& to_from_from) const {
  const Eigen::Vector3d up = axis.normalized();
  PoseEdge edge{from, to, to_from_from, Eigen::Matrix<double, 6, 6>::Zero()};
  edge.to_from_from.rotation = (lean(up, to_from_from) * to_from_from.rotation).normalized();
  const Eigen::Matrix3d along = up * up.transpose();
  edge.information.bottomRightCorner<3, 3>() =
      (Eigen::Matrix3d::Identity() - along) / (angle_sigma * angle_sigma);
  if (kind == ScanStand::kTable) {
    edge.to_from_from.translation -= up * up.dot(to_from_from.translation);
    edge.information.topLeftCorner<3, 3>() = along / (height_sigma * height_sigma);
  }
  return edge;
}

}  // namespace facula
