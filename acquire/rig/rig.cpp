// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/acquire/rig/rig.hpp>

namespace facula {

void Rig::check() const {
  camera.check();
  require(!lasers.empty(), "rig '", name, "': expected at least one [[laser]], got none");
  for (const LaserPlane& laser : lasers) laser.check();
  axis.check();
}

}  // namespace facula
