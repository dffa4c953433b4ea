// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/global_registration.hpp>

#include <vector>

namespace facula {

struct JudgedPose {
  PairResult pair;
  PoseScore score;
};

/// One figure to rank poses by: the overlap, less where points are off the surface or in free
/// space.
double quality(const PoseScore& score);

/// Whether a pose explains both scans: enough of them meets, hardly a point stands where the other
/// scan looked through, and near the other scan most points lie on its surface.
bool fits(const PoseScore& score, double min_overlap);

/// Of the refined poses, best first. `rough` are the candidates before refinement, best first,
/// which give the figures where nothing was worth refining.
GlobalResult verdict_on(const std::vector<JudgedPose>& refined,
                        const std::vector<JudgedPose>& rough,
                        const GlobalOptions& options);

}  // namespace facula
