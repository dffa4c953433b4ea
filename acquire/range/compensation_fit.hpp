// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/range/compensation_table.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace facula {

/// The line as it was seen on one flat wall, square to the camera's axis: one position per line of
/// the picture, NaN where the line was not seen. Averaged over frames where there are several.
struct PlaneView {
  std::string name;               ///< for messages: "1005 mm"
  std::vector<double> positions;  ///< [px]
};

struct CompensationOptions {
  int window = 5;        ///< neighbours to both sides that are averaged, s [lines]
  int middle_lines = 9;  ///< about the middle line, whose mean is taken as P_i [lines]

  /// Each line's position is replaced by the value there of a parabola fitted over this many lines
  /// to both sides, 0 = left as measured [lines]. Bow and tilt are smooth, noise is not.
  int smooth = 20;
  void check() const;
};

/// How one plane stands in the table.
struct CompensationPlane {
  std::string name;
  double position = 0;       ///< P_i [px]
  double largest_shift = 0;  ///< of all lines seen, absolute [px]
  double scatter = 0;        ///< of the positions about the smoothed line [px]
  std::size_t seen = 0;      ///< lines
  std::size_t filled = 0;    ///< lines not seen, taken from their neighbours
  double held_out_rms =
      0;  ///< what the table without this plane leaves of it; NaN at the ends [px]
  double uncorrected_rms = 0;  ///< what it would be without a table [px]
};

struct CompensationFit {
  CompensationTable table;
  std::vector<CompensationPlane> planes;  ///< in the order of the table
  std::vector<std::string> warnings;
};

/// Builds the table from walls at several distances, in any order. Throws Error, naming the plane,
/// when fewer than two are given, the picture's height differs, too few lines were seen, the middle
/// was not seen, or two planes cross.
CompensationFit fit_compensation(const std::vector<PlaneView>& views,
                                 const CompensationOptions& options = {});

}  // namespace facula
