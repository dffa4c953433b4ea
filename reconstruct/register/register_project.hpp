// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/progress.hpp>
#include <facula/reconstruct/register/icp.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <vector>

namespace facula {

struct RegisterOptions {
  double voxel = 0.02;  ///< clouds are thinned to this before ICP [m], above 0
  IcpOptions icp;
  Progress progress;  ///< called per scan; may be empty
};

/// Moves every scan after the first onto the union of those before it, starting from its given
/// pose. The first scan stays where it is. Returns one result per moved scan (in order); the
/// project's poses are updated.
std::vector<IcpResult> register_project(ScanProject& project, const RegisterOptions& options = {});

}  // namespace facula
