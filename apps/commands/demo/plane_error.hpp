// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/simulate/scene.hpp>
#include <facula/apps/cli/figures.hpp>
#include <facula/reconstruct/measure/plane.hpp>

#include <string>
#include <vector>

namespace facula {

/// A wall, the floor or the ceiling of a scene's rooms, in the world frame.
struct TrueWall {
  std::string name;
  Plane plane;
};
std::vector<TrueWall> true_walls(const Scene& scene);

/// Per wall the largest plane that lies within 5 degrees and 50 mm of it: error of its direction
/// and of its place at the centroid, and its flatness (a true wall has none). Then the largest
/// error of the angles between all walls found.
void report_plane_errors(const std::vector<ExtractedPlane>& planes,
                         const std::vector<TrueWall>& walls,
                         Figures& figures);

/// Errors of the angles between all walls found, in degrees and in their standard uncertainties.
void report_angle_errors(const std::vector<ExtractedPlane>& planes,
                         const std::vector<TrueWall>& walls,
                         Figures& figures);

}  // namespace facula
