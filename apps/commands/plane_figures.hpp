// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/reconstruct/measure/plane_relations.hpp>

#include <filesystem>
#include <vector>

namespace facula {

/// Planes, angles of all pairs, distances of the pairs that are parallel to 10 degrees, with their
/// standard uncertainties.
void report_planes(const std::vector<ExtractedPlane>& planes,
                   Figures& figures,
                   const RelationOptions& options = {});

/// A line per plane with its covariance (of tilts about axis u and v and of the offset at the
/// centroid), units in the headings; whole or not at all.
void write_planes_csv(const std::filesystem::path& path, const std::vector<ExtractedPlane>& planes);

}  // namespace facula
