// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace facula {

/// Set range/os3ds-rotating-lidar: one corner of a room, scanned again and again by a home-built
/// scanner. Its notes give the angles of its planes over the scans, mean and standard deviation.
struct Series {
  std::vector<double> values;

  double mean() const;
  double spread() const;  ///< standard deviation
};

/// Angles of the normals, as the notes give them (180 degrees less the corner's) [deg] and
/// distances [mm] of the two walls A, B and the ceiling C over six scans.
struct CornerSeries {
  Series ab, ac, bc, a, b, c;
};

/// With `tilt_zero` [rad] added to every tilt and the notes' band of 15 mm. Throws Error when a
/// scan lacks one of the planes.
CornerSeries corner_series(const std::filesystem::path& folder, double tilt_zero);

/// The zero of the tilt [deg] and the share of points on planes with it, over the rising sweeps of
/// seven scans: the falling ones are off by a backlash that was set anew for every scan. All scans
/// but 2155, which its author calls bad.
struct TiltZeroSeries {
  Series zero, on_planes;
};
TiltZeroSeries tilt_zero_series(const std::filesystem::path& folder);

}  // namespace facula
