// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/reconstruct/measure/profile_measures.hpp>

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace facula {

struct ProfilePieceOptions {
  double tolerance = 0;         ///< farthest point from its piece's line [m]; 0 = 5 times the noise
                                ///< that neighbouring points show
  std::size_t min_points = 10;  ///< shortest piece [1], at least 5

  void check() const;
};

/// A straight part of a profile and the line through its points.
struct ProfilePiece {
  ProfileSpan span;                                      ///< points of the profile
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();      ///< mean of the points, on the line [m]
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit length, x >= 0
  double scatter = 0;       ///< of the points about the line, n - 2 degrees of freedom [m]
  double offset_sigma = 0;  ///< of the line's place square to it, at the middle [m]
  double angle_sigma = 0;   ///< of its direction [rad]

  Eigen::Vector2d normal() const { return {-direction.y(), direction.x()}; }
};

/// The straight parts of a profile sorted by `across`, left to right: split where it leaves the
/// chord (Ramer 1972, Douglas and Peucker 1973), joined again where one line serves two parts, then
/// least squares. Throws Error when a point is not finite.
std::vector<ProfilePiece> straight_pieces(const std::vector<Eigen::Vector2d>& profile,
                                          const ProfilePieceOptions& options = {});

/// A length and its standard uncertainty.
struct ProfileLength {
  double value = 0;  ///< [m]
  double sigma = 0;  ///< [m]
};

/// Length of the side that a piece is of: from corner to corner, the corners being where its line
/// meets those of its neighbours. Nothing where it does not meet both at an angle of 5 degrees or
/// more, within `gap` [m] of its ends.
std::optional<ProfileLength> side_length(const std::vector<Eigen::Vector2d>& profile,
                                         const std::vector<ProfilePiece>& pieces,
                                         std::size_t piece,
                                         double gap);

/// The step from one piece to another: the other's mean distance from the line of the first.
StepMeasure step_between(const std::vector<Eigen::Vector2d>& profile,
                         const ProfilePiece& base,
                         const ProfilePiece& top);

/// The lowest piece that is level to 5 degrees, as base of all others; nothing where there is none.
std::optional<std::size_t> base_piece(const std::vector<ProfilePiece>& pieces);

}  // namespace facula
