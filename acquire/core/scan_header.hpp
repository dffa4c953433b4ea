// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace facula {

/// What a scan knows beside its cells, as comments of a PCD header: "facula scan 1"; "facula stand
/// upright" (or table) where the capture says so; and for every column "facula column <number>
/// <axis position> <time> <origin x> <origin y> <origin z>".
std::vector<std::string> scan_comments(const PolarScan& scan);

/// Whether scan_comments() wrote into this header.
bool has_scan_comments(const std::vector<std::string>& comments);

/// Fills the columns and the stand of `scan`. Throws Error naming the file when a column is missing
/// or torn, or the stand is none that is known.
void read_scan_comments(const std::vector<std::string>& comments,
                        PolarScan& scan,
                        const std::filesystem::path& path);

/// A pose as a PCD viewpoint (tx ty tz qw qx qy qz) and back. pose_of() throws Error naming the
/// file when the quaternion has no direction or a number is not finite.
std::array<double, 7> viewpoint_of(const RigidTransform& world_from_scan);
RigidTransform pose_of(const std::array<double, 7>& viewpoint, const std::filesystem::path& path);

}  // namespace facula
