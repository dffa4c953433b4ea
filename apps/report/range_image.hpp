// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/polar_scan.hpp>
#include <facula/apps/report/drawing.hpp>
#include <facula/apps/report/grid_layout.hpp>

namespace facula {

/// How range_image() lays out the cells of a scan, inside the margins of a plot.
GridLayout range_image_layout(const PolarScan& scan);

/// Distance from the sensor origin of each column by colour, cells without a point dark. Columns of
/// the scan run to the right, rows down, as in the camera. Throws Error when the scan is not
/// consistent; a scan without valid cells gives a picture that says so.
Image8 range_image(const PolarScan& scan);

}  // namespace facula
