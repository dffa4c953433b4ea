// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/volumetric_scale.hpp>

#include <algorithm>

namespace facula {
namespace {

constexpr double kTruncationVoxels = 3;

double median_step(std::vector<double> steps) {
  const std::size_t scans = steps.size();
  steps.erase(std::remove_if(steps.begin(), steps.end(), [](double s) { return !(s > 0); }),
              steps.end());
  require(!steps.empty(),
          "none of the ",
          scans,
          " scans has a surface: a piece of one needs three neighbouring points with a line of "
          "sight");
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

}  // namespace

VolumetricScale volumetric_scale(const VolumetricOptions& options,
                                 const std::vector<double>& steps) {
  VolumetricScale scale;
  scale.voxel = options.voxel > 0 ? options.voxel : median_step(steps);
  scale.truncation = options.truncation > 0 ? options.truncation : kTruncationVoxels * scale.voxel;
  return scale;
}

RangeSurfaceOptions range_surface_options(const VolumetricOptions& options) {
  return {.max_incidence = options.max_incidence,
          .border_cells = options.border_cells,
          .num_threads = options.num_threads};
}

}  // namespace facula
