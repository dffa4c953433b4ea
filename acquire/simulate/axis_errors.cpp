// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/random.hpp>
#include <facula/acquire/simulate/axis_errors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace facula {
namespace {

constexpr std::uint64_t kAxisStream = std::numeric_limits<std::uint64_t>::max();

// The direction of the first step that moves, 1 or -1.
double first_direction(const std::vector<double>& programme) {
  for (std::size_t i = 1; i < programme.size(); ++i) {
    if (programme[i] != programme[i - 1]) return programme[i] > programme[i - 1] ? 1.0 : -1.0;
  }
  return 1.0;
}

// The play operator: the driven side rests while the drive crosses the gap. The gap lies behind the
// drive at the start, where the axis was homed in the first direction.
void take_up_play(std::vector<double>& positions, double backlash) {
  if (backlash == 0 || positions.empty()) return;
  const double ahead = first_direction(positions) > 0 ? backlash : 0.0;
  double driven = positions.front();
  for (double& position : positions) {
    driven = std::clamp(driven, position - (backlash - ahead), position + ahead);
    position = driven;
  }
}

}  // namespace

std::vector<double> travelled_positions(const std::vector<double>& programme,
                                        const AxisErrors& errors,
                                        std::uint64_t seed) {
  std::vector<double> positions = programme;
  take_up_play(positions, errors.backlash);
  Random random(seed, kAxisStream);
  for (double& position : positions) {
    if (errors.periodic_amplitude != 0) {
      const double turn = 2 * std::numbers::pi * position / errors.period + errors.phase;
      position += errors.periodic_amplitude * std::sin(turn);
    }
    position += errors.speed * errors.latency;
    if (errors.noise != 0) position += errors.noise * random.normal();
  }
  return positions;
}

}  // namespace facula
