// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/register/scan_project.hpp>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace facula {

/// Ranges of a single beam that two axes point: what home-built scanners write. Equal lengths.
struct PanTiltList {
  std::vector<double> range;      ///< [m], above 0
  std::vector<double> pan;        ///< about z, from x towards y [rad]
  std::vector<double> tilt;       ///< from +z downwards; pi/2 is level [rad]
  std::vector<double> intensity;  ///< over the strongest of the list [0..1]; empty when not told

  std::size_t size() const { return range.size(); }
};

/// True for a .csv file whose header names range, pan and tilt columns.
bool is_pan_tilt_list(const std::filesystem::path& path);

/// Reads a table with the columns range_mm, pan_deg, tilt_deg and, if there, strength (or the same
/// with _m, _rad). Ranges of 0 mean that nothing came back and are left out. Throws Error when the
/// table is none of this kind, a range is negative, or no range is left.
PanTiltList read_pan_tilt_list(const std::filesystem::path& path);

/// The points x = r sin(t) cos(p), y = r sin(t) sin(p), z = r cos(t) with t = tilt + tilt_zero
/// [rad], seen from the frame's origin. Its grid has a column per run of equal pan and a row per
/// step of tilt; it is empty where tilt has no common step.
PosedCloud posed_cloud(const PanTiltList& list, double tilt_zero = 0);

/// The sweeps of a list by the way the tilt axis moved. What its gears have of play shows between
/// the two, not within one.
struct PanTiltSweeps {
  PanTiltList rising;   ///< tilt grows from point to point
  PanTiltList falling;  ///< empty for a scanner that measures on one way only
};
PanTiltSweeps sweeps_of(const PanTiltList& list);

}  // namespace facula
