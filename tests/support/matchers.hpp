// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>

#include <functional>
#include <string>

#include <gtest/gtest.h>

namespace facula {

/// Passes when the poses differ by at most `max_angle` [rad] and `max_distance` [m]; says by how
/// many degrees and millimetres otherwise.
testing::AssertionResult is_near_pose(const RigidTransform& actual,
                                      const RigidTransform& expected,
                                      double max_angle,
                                      double max_distance);

/// Passes when the points lie at most `max_distance` [m] apart.
testing::AssertionResult is_near_point(const Eigen::Vector3d& actual,
                                       const Eigen::Vector3d& expected,
                                       double max_distance);

/// The sentence of the facula::Error that `action` throws; fails the test when it throws none.
std::string error_of(const std::function<void()>& action);

}  // namespace facula
