// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/tests/support/matchers.hpp>

namespace facula {

testing::AssertionResult is_near_pose(const RigidTransform& actual,
                                      const RigidTransform& expected,
                                      double max_angle,
                                      double max_distance) {
  const double angle = rotation_angle(actual.inverse() * expected);
  const double distance = (actual.translation - expected.translation).norm();
  if (angle <= max_angle && distance <= max_distance) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << "poses differ by " << angle * 57.29577951308232 << " degrees (allowed "
         << max_angle * 57.29577951308232 << ") and " << distance * 1000 << " mm (allowed "
         << max_distance * 1000 << ")";
}

testing::AssertionResult is_near_point(const Eigen::Vector3d& actual,
                                       const Eigen::Vector3d& expected,
                                       double max_distance) {
  const double distance = (actual - expected).norm();
  if (distance <= max_distance) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << "(" << actual.transpose() << ") lies " << distance * 1000 << " mm from ("
         << expected.transpose() << "), allowed " << max_distance * 1000 << " mm";
}

std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  ADD_FAILURE() << "expected a facula::Error, none was thrown";
  return {};
}

}  // namespace facula
