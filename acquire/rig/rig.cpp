// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>

#include <set>

namespace facula {

void Rig::check() const {
  camera.check();
  require(!lasers.empty(), "rig '", name, "': expected at least one [[laser]], got none");
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
  if (covariance) check_covariance(*this, *covariance);
}

}  // namespace facula
