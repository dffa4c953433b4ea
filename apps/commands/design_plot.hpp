// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/image_view.hpp>
#include <facula/acquire/range/range_design.hpp>

namespace facula {

/// Nearest distance, and resolution at `distance` [m], over f s from 0 to twice that of the design,
/// which is marked (source B, figure 3.4).
Image8 design_plot(const RangeDesign& design, double distance);

}  // namespace facula
