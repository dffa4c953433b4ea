// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/profile/profile_polynomial.hpp>
#include <facula/acquire/profile/sheet_projection.hpp>
#include <facula/acquire/range/compensation_table.hpp>
#include <facula/acquire/range/range_model.hpp>
#include <facula/acquire/rig/axis.hpp>
#include <facula/acquire/rig/camera.hpp>
#include <facula/acquire/rig/laser_plane.hpp>
#include <facula/acquire/two_line/two_line_head.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Which way the stripe runs in the image.
enum class StripeDirection {
  kPerRow,    ///< roughly upright: one position per image row
  kPerColumn  ///< roughly level: one position per image column
};

/// How well a calibration knows the rig: the covariance of the parameters it estimated, in the
/// units their names end with (see rig_parameters.hpp). A parameter that is not named is taken as
/// exact.
struct RigCovariance {
  std::vector<std::string> parameters;  ///< "camera.fx_px", "laser.red.distance_mm", ...
  Eigen::MatrixXd matrix;               ///< symmetric, one row and column per parameter
};

/// What a rig must hold to be used.
enum class RigParts {
  kWhole,  ///< camera and something that measures: a sheet of light, or a simpler calibration
  kCamera  ///< a camera at least: the rest is still to be calibrated
};

/// A scanner head: camera, one or more sheets of light, and an axis. Lengths in metres here; in
/// rig.toml the unit stands in the key (_mm, _deg, _px).
struct Rig {
  std::string name = "rig";
  Camera camera;
  std::vector<LaserPlane> lasers;  ///< each with a name of its own; at least one, unless the rig
                                   ///< carries one of the calibrations below
  Axis axis;
  StripeDirection stripe_direction = StripeDirection::kPerRow;
  std::optional<RigCovariance> covariance;  ///< absent where nobody estimated it

  // Calibrations of heads that have no board: depth straight from the stripe's position.
  std::optional<RangeModel> range;                ///< takes the sheet's place where there is none
  std::optional<CompensationTable> compensation;  ///< applied before `range`
  std::optional<ProfilePolynomial> profile_polynomial;
  std::optional<SheetProjection> profile_projection;
  std::optional<TwoLineHead> two_line;

  /// How many lights a capture can name: the sheets, or the one that the range model stands for.
  std::size_t light_count() const { return lasers.empty() && range ? 1 : lasers.size(); }

  /// Throws Error naming the first value that cannot be.
  void check(RigParts needed = RigParts::kWhole) const;
};

}  // namespace facula
