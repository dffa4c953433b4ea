// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/apps/commands/axis_programme.hpp>

#include <cmath>
#include <string>

namespace facula {
namespace {

constexpr double kMostPositions = 100000;

struct Steps {
  double from = 0;
  double to = 0;
  double step = 0;
};

std::vector<double> positions_of(const Steps& steps, const std::string& unit) {
  require(steps.step > 0 && steps.to >= steps.from,
          "expected --to-",
          unit,
          " at or above --from-",
          unit,
          " and --step-",
          unit,
          " above 0, got a programme without positions; change them");
  // A step that fits the way but for rounding still counts.
  const double count = std::floor((steps.to - steps.from) / steps.step + 1e-9) + 1;
  require(count <= kMostPositions,
          "expected at most ",
          kMostPositions,
          " positions, got ",
          count,
          "; choose a larger --step-",
          unit);
  std::vector<double> positions;
  positions.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < static_cast<int>(count); ++i)
    positions.push_back(steps.from + i * steps.step);
  return positions;
}

std::vector<double> turning_positions(const AxisProgramme& p) {
  const Steps steps{p.from_angle.value_or(0),
                    p.to_angle.value_or(360 * kDegrees.factor),
                    p.step_angle.value_or(kDegrees.factor)};
  std::vector<double> positions = positions_of(steps, "deg");
  const double turn = positions.back() - positions.front();
  if (positions.size() > 1 && std::abs(turn - 360 * kDegrees.factor) < 1e-9) positions.pop_back();
  return positions;
}

}  // namespace

void declare_axis_programme(Arguments& arguments, AxisProgramme& p) {
  arguments.number(
      "--from-deg", p.from_angle, kDegrees, "first position of a turning axis; else 0");
  arguments.number("--to-deg",
                   p.to_angle,
                   kDegrees,
                   "last position; else 360; the end of a full turn is not taken twice");
  arguments.number("--step-deg", p.step_angle, kDegrees, "between two frames; else 1");
  arguments.number(
      "--from-mm", p.from_length, kMillimetres, "first position of a linear axis; else 0");
  arguments.number("--to-mm", p.to_length, kMillimetres, "last position; else 100");
  arguments.number("--step-mm", p.step_length, kMillimetres, "between two frames; else 1");
}

std::vector<double> axis_positions(const AxisProgramme& p, const Axis& axis) {
  const bool angles = p.from_angle || p.to_angle || p.step_angle;
  const bool lengths = p.from_length || p.to_length || p.step_length;
  require(!angles || axis.is_revolute(),
          "expected --from-mm, --to-mm, --step-mm or none of them "
          "for a rig whose axis is '",
          to_string(axis.kind),
          "', got degrees; use the other ones");
  require(!lengths || axis.kind == AxisKind::kLinear,
          "expected --from-deg, --to-deg, --step-deg "
          "or none of them for a rig whose axis is '",
          to_string(axis.kind),
          "', got millimetres; use the other ones");
  if (axis.is_revolute()) return turning_positions(p);
  if (axis.kind == AxisKind::kNone) return {0.0};
  return positions_of(
      {p.from_length.value_or(0), p.to_length.value_or(0.1), p.step_length.value_or(0.001)}, "mm");
}

}  // namespace facula
