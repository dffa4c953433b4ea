// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/pair_registration.hpp>
#include <facula/reconstruct/register/pair_system.hpp>

#include <vector>

namespace facula {

/// How well a pose is known, as PairResult tells it.
struct PoseCertainty {
  Matrix6 information;
  Matrix6 covariance;
  std::vector<UndecidedDirection> undecided;
};

/// Covariance by the sandwich formula of M-estimators (Huber 1964), with pairs clustered (Liang and
/// Zeger 1986) by cells of the target of edge `cell` [m], within which points and normals share
/// their errors; each cluster counts by what leaving it out would change, and their sum is shrunk
/// as far as their number asks for. The noise is that of the residuals, whatever the weights say.
/// Undecided directions carry no information and a variance of the overlap's size.
PoseCertainty pose_certainty(const std::vector<PointPair>& pairs,
                             const PairSystem& system,
                             const PairOptions& options,
                             double cell);

}  // namespace facula
