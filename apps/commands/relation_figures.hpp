// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/apps/commands/plane_search.hpp>

#include <cstddef>

#include <Eigen/Core>

namespace facula {

/// Angle and corner of every pair, with standard uncertainties and, for pairs that are nearly
/// parallel or square, the width of the tolerance zone after ISO 1101. `reference` as
/// plane_pairs().
FigureTable angle_table(const FoundPlanes& found,
                        std::size_t reference,
                        const RelationOptions& options);

/// How far every plane leans from upright or level, whichever is nearer. `up` of any length above
/// 0.
FigureTable plumb_table(const FoundPlanes& found,
                        const Eigen::Vector3d& up,
                        const RelationOptions& options);

/// Distances of the pairs that are parallel to `max_angle` [rad].
FigureTable distance_table(const FoundPlanes& found,
                           std::size_t reference,
                           double max_angle,
                           const RelationOptions& options);

}  // namespace facula
