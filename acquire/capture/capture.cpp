// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/capture/capture.hpp>
#include <facula/acquire/core/error.hpp>

namespace facula {
namespace {

using Bound = std::optional<double>;

void check_order(const Bound& least, const Bound& greatest, const char* what) {
  require(!least || !greatest || *least <= *greatest,
          "volume: expected min_",
          what,
          " below max_",
          what,
          ", got ",
          least.value_or(0) * 1000,
          " and ",
          greatest.value_or(0) * 1000,
          " mm");
}

}  // namespace

std::size_t frames_per_exposure(Alternation alternation) {
  switch (alternation) {
    case Alternation::kNone:
      return 1;
    case Alternation::kOnFirst:
    case Alternation::kOffFirst:
      return 2;
    case Alternation::kOnOffOn:
    case Alternation::kOffOnOff:
      return 3;
  }
  return 1;
}

bool WorkVolume::contains(const Eigen::Vector3d& x_in_scan, double depth) const {
  if (max_radius && x_in_scan.head<2>().norm() > *max_radius) return false;
  if (min_z && x_in_scan.z() < *min_z) return false;
  if (max_z && x_in_scan.z() > *max_z) return false;
  if (min_depth && depth < *min_depth) return false;
  return !(max_depth && depth > *max_depth);
}

void WorkVolume::check() const {
  require(!max_radius || *max_radius > 0,
          "volume: expected max_radius_mm above 0, got ",
          max_radius.value_or(0) * 1000);
  check_order(min_z, max_z, "z_mm");
  check_order(min_depth, max_depth, "depth_mm");
}

}  // namespace facula
