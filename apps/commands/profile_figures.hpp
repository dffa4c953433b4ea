// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/reconstruct/measure/cylinder.hpp>
#include <facula/reconstruct/measure/profile_circle.hpp>
#include <facula/reconstruct/measure/profile_pieces.hpp>
#include <facula/reconstruct/measure/sphere.hpp>

#include <vector>

namespace facula {

/// The straight pieces of a section: length where both corners are seen, height over the lowest
/// level one (thickness), each with its uncertainty. `gap` [m] between a corner and the points.
FigureTable piece_table(const std::vector<Eigen::Vector2d>& profile,
                        const std::vector<ProfilePiece>& pieces,
                        double gap);

void report_circle(const CircleFit& fit, Figures& figures);
void report_cylinder(const CylinderFit& fit, Figures& figures);
void report_sphere(const SphereFit& fit, Figures& figures);

}  // namespace facula
