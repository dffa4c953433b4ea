// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/calibrate/joint_fit.hpp>

#include <string>
#include <vector>

namespace facula {

/// The fit, with a scale of its own for every board that contradicts the first one.
struct ScaledFit {
  JointFreedom freedom;  ///< scales of the boards in conflict are free
  JointSolution solution;
  std::vector<BoardScale> scales;  ///< of the second board on
};

/// Frees the sizes of all boards but the first, keeps free those off 1 by more than 3 sigma, and
/// fits again with the others at 1. Replaces state, marks and noise.
ScaledFit fit_with_scales(const JointOptions& options,
                          std::vector<JointSight>& sights,
                          JointNoise& noise,
                          JointState& state);

/// One sentence about a board's size, empty when there is nothing to say.
std::string scale_sentence(const BoardScale& scale);

}  // namespace facula
