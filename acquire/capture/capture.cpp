// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture.hpp>

namespace facula {

bool WorkVolume::contains(const Eigen::Vector3d& x_in_scan, double depth) const {
  if (max_radius && x_in_scan.head<2>().norm() > *max_radius) return false;
  if (min_z && x_in_scan.z() < *min_z) return false;
  if (max_z && x_in_scan.z() > *max_z) return false;
  if (min_depth && depth < *min_depth) return false;
  return !(max_depth && depth > *max_depth);
}

}  // namespace facula
