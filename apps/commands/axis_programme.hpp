// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/rig/axis.hpp>
#include <facula/apps/cli/arguments.hpp>

#include <optional>
#include <vector>

namespace facula {

/// From where to where an axis moves, and in which steps. Angles for axes that turn, lengths for
/// linear ones.
struct AxisProgramme {
  std::optional<double> from_angle;   ///< [rad]
  std::optional<double> to_angle;     ///< [rad]
  std::optional<double> step_angle;   ///< [rad]
  std::optional<double> from_length;  ///< [m]
  std::optional<double> to_length;    ///< [m]
  std::optional<double> step_length;  ///< [m]
};

/// --from-deg --to-deg --step-deg and --from-mm --to-mm --step-mm.
void declare_axis_programme(Arguments& arguments, AxisProgramme& programme);

/// Every position, both ends included; one position 0 for a rig whose axis is none. What is not
/// given: 0 to 360 degrees (one step less for a full turn) in steps of 1; 0 to 100 mm in steps of
/// 1. Throws Error when the unit does not fit the axis or there would be no or too many positions.
std::vector<double> axis_positions(const AxisProgramme& programme, const Axis& axis);

}  // namespace facula
