// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

namespace facula {

/// Source B's table against everything that keeps the line of a flat wall from being one position
/// in all lines of the picture: tilt and bow of the sheet, distortion, mounting ((2.4) to (2.9) of
/// "Design of 3D Laser Radar Based on Laser Triangulation"). A line is an image row for a stripe
/// per row, an image column for a stripe per column.
///
/// The correction of a position z in line u is the mean of the corrections of the lines u - s to
/// u + s of the two planes that z lies between, each weighted by 1 / L, L its distance from (z, u)
/// in the picture. (2.8) as printed lacks the division by the sum of 1 / L and is no mean; with it,
/// the correction tends to (2.7) when L tends to 0. Beyond the first and last plane that plane
/// alone counts.
class CompensationTable {
 public:
  /// What one flat wall showed: where the line lay, and where it ought to have.
  struct Plane {
    double position = 0;           ///< P_i, that of the line in the middle [px]
    std::vector<double> measured;  ///< Z_i(u), one per line of the picture [px]
  };

  /// Planes in the order of their positions; `window` is s [lines]. Throws Error when there are
  /// none, they differ in their number of lines, hold a value that is not finite, or are out of
  /// order in any line.
  CompensationTable(std::vector<Plane> planes, int window);

  const std::vector<Plane>& planes() const { return planes_; }
  int window() const { return window_; }
  int lines() const { return static_cast<int>(planes_.front().measured.size()); }

  struct Correction {
    double shift = 0;  ///< to be added to the position [px]
    double slope = 0;  ///< how the shift grows with the position, for error propagation [1]
  };

  /// Of a stripe at `position` [px] in `line`; lines outside the table count as its first and last.
  Correction correction(int line, double position) const;

  /// position + shift.
  double corrected(int line, double position) const {
    return position + correction(line, position).shift;
  }

 private:
  std::vector<Plane> planes_;
  int window_ = 0;
  std::vector<double> by_line_;    ///< Z_i(u) at u * planes + i, for the search
  std::vector<double> squares_;    ///< (m - u)^2 for m = u - s ... u + s
  std::vector<double> positions_;  ///< Z_i(u) at i * padded + s + u, far away beyond the picture
  std::vector<double> shifts_;     ///< Delta_i(u) likewise, 0 beyond the picture
  std::size_t padded_ = 0;         ///< lines + 2 s
};

}  // namespace facula
