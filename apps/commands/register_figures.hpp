// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/reconstruct/register/register_scans.hpp>
#include <facula/reconstruct/register/scan_project.hpp>

#include <vector>

namespace facula {

/// What registration has to say: the scans placed with their sigmas, the pairs behind them with
/// their residuals, and the scans refused with the reasons. `before`: the poses at the start.
void report_registration(const ScanProject& project,
                         const std::vector<RigidTransform>& before,
                         const RegisterScansResult& result,
                         Figures& figures);

}  // namespace facula
