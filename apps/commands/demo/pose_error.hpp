// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/rigid_transform.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/apps/commands/demo/demo_settings.hpp>
#include <facula/apps/commands/demo/recorded_scan.hpp>
#include <facula/reconstruct/register/register_scans.hpp>

#include <cstdint>
#include <vector>

namespace facula {

/// The true pose moved by settings.start_distance and turned by settings.start_angle, both in a
/// random direction that the seed and the scan's number choose.
RigidTransform rough_pose(const RigidTransform& world_from_scan,
                          std::uint64_t scan,
                          const DemoSettings& settings);

/// Per scan: how wrong its pose was before and is after registration. The first scan defines the
/// world and keeps its true pose.
void report_pose_errors(const std::vector<RecordedScan>& scans,
                        const ScanProject& registered,
                        const RegisterScansResult& result,
                        Figures& figures);

}  // namespace facula
