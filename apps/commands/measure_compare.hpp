// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/point_cloud.hpp>
#include <facula/apps/cli/command.hpp>
#include <facula/reconstruct/measure/deviation.hpp>

namespace facula {

/// Points and a mesh or cloud -> deviations.
Command measure_compare_command();

/// Deviations of points from what a file holds: a mesh, or scans or a cloud, signed where it has
/// normals or knows its sensor.
Deviations deviations_from_file(const std::vector<Eigen::Vector3f>& points,
                                const std::filesystem::path& reference,
                                const DeviationOptions& options);

}  // namespace facula
