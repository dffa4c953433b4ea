// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>

#include <set>

namespace facula {

void Rig::check(RigParts needed) const {
  camera.check();
  require(needed == RigParts::kCamera || !lasers.empty() || range || profile_polynomial ||
              profile_projection || two_line,
          "rig '",
          name,
          "': expected at least one [[laser]], or a [range], [profile] or [two_line] calibration, "
          "got none");
  std::set<std::string> names;
  for (const LaserPlane& laser : lasers) {
    laser.check();
    require(names.insert(laser.name).second,
            "rig '",
            name,
            "': two [[laser]] are called '",
            laser.name,
            "'; captures tell them apart by their names");
  }
  axis.check();
  if (range) range->check();
  const int lines = stripe_direction == StripeDirection::kPerRow ? camera.height : camera.width;
  require(!compensation || compensation->lines() == lines,
          "rig '",
          name,
          "': expected a compensation table of ",
          lines,
          " lines, as the picture has, got ",
          compensation ? compensation->lines() : 0);
  if (profile_polynomial) profile_polynomial->check();
  if (profile_projection) profile_projection->check();
  if (two_line) two_line->check();
  if (covariance) check_covariance(*this, *covariance);
}

}  // namespace facula
