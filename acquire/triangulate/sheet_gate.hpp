// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/stripe/column_gate.hpp>

namespace facula {

/// The columns of every row in which the lit sheet can show at all: where the ray meets the sheet
/// within the capture's work volume (depths always; radius and height where the axis leaves them
/// alone, that is for revolute axes and none). What a mirror or a lamp puts elsewhere is not looked
/// at; a mirrored stripe whose apparent point lies within the volume passes. `margin` [px] is left
/// on both sides for errors of the calibration and for half of a line cut by a bound. Empty, that
/// is no gate, where the volume bounds nothing, the positions are measured against a bare bed, or
/// the whole image is within. Rows in which no column is allowed have end = first. Costs some 40
/// triangulations per row, once per capture.
ColumnGate sheet_gate(const Capture& capture, double margin = 8);

}  // namespace facula
