// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/apps/cli/figures.hpp>
#include <facula/reconstruct/measure/flatness.hpp>
#include <facula/reconstruct/measure/flatness_uncertainty.hpp>

#include <limits>
#include <optional>
#include <vector>

namespace facula {

/// What was measured on one surface.
struct MeasuredFlatness {
  Flatness flatness;
  std::optional<FlatnessUncertainty> uncertainty;  ///< nothing where no noise is known
};

/// A row per surface: FLTt, FLTp, FLTv, FLTq, the minimum zone, and what noise does to FLTt.
FigureTable flatness_table(const std::vector<MeasuredFlatness>& surfaces);

/// A sentence on what the noise of a surface lets one say of it.
std::string flatness_verdict(const MeasuredFlatness& surface);

/// How far from its plane a search let a surface reach.
struct SearchBand {
  double reach = std::numeric_limits<double>::infinity();  ///< farthest point of a plane [m]
  bool widened = false;  ///< by the noise of points that know theirs, as plane.hpp has it
};

/// Whether the search that found the plane cut it out of a surface that reaches farther than its
/// band: the points fill the band rather than crowd about the middle.
bool is_cut(const MeasuredFlatness& surface, const SearchBand& band);

}  // namespace facula
