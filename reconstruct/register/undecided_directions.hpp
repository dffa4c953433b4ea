// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/pair_system.hpp>

#include <vector>

namespace facula {

/// The motions that the shape of the overlap decides and those it does not, as two orthonormal
/// bases of twists (m, rad * radius) about the system's pivot.
struct DecidedMotions {
  Eigen::Matrix<double, 6, Eigen::Dynamic> decided;
  Eigen::Matrix<double, 6, Eigen::Dynamic> undecided;  ///< pure slides first
};

DecidedMotions decided_motions(const PairSystem& system);

/// Says a motion in words, in the target's frame: "slides along (0.98, 0.17, 0.01)" or "turns about
/// (0, 0, 1) through (1.2, 0.4, 0) m".
std::string motion_in_words(const Vector6& twist, const PairSystem& system);

}  // namespace facula
