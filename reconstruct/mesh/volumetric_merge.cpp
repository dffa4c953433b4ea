// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/mesh/distance_volume.hpp>
#include <facula/reconstruct/mesh/range_surface.hpp>
#include <facula/reconstruct/mesh/surface_extraction.hpp>
#include <facula/reconstruct/mesh/volumetric_merge.hpp>
#include <facula/reconstruct/mesh/volumetric_scale.hpp>

#include <cmath>
#include <optional>
#include <vector>

namespace facula {
namespace {

std::vector<RangeSurface> surfaces_of(const ScanProject& project,
                                      const VolumetricOptions& options) {
  std::vector<RangeSurface> surfaces;
  surfaces.reserve(project.scans.size());
  for (const PosedCloud& scan : project.scans) {
    surfaces.push_back(range_surface(scan, range_surface_options(options)));
  }
  return surfaces;
}

std::vector<double> steps_of(const std::vector<RangeSurface>& surfaces) {
  std::vector<double> steps;
  steps.reserve(surfaces.size());
  for (const RangeSurface& s : surfaces) steps.push_back(s.triangles.empty() ? 0 : s.step);
  return steps;
}

}  // namespace

void VolumetricOptions::check() const {
  const auto length = [](double value, const char* name) {
    require(value >= 0 && std::isfinite(value),
            name,
            " is ",
            value,
            " m; give a length above 0, or 0 to take it from the scans");
  };
  length(voxel, "voxel");
  length(truncation, "truncation");
  require(max_incidence > 0 && max_incidence < M_PI / 2,
          "max_incidence is ",
          max_incidence,
          " rad; give an angle between 0 and pi/2");
  require(border_cells >= 0 && border_cells < 1000,
          "border_cells is ",
          border_cells,
          "; give a number of cells from 0 to 1000");
  require(max_memory > 0, "max_memory is ", max_memory, " bytes; give a number above 0");
}

VolumetricResult merge_volumetric(const ScanProject& project, const VolumetricOptions& options) {
  options.check();
  const std::vector<RangeSurface> surfaces = surfaces_of(project, options);
  VolumetricResult result;
  const VolumetricScale scale = volumetric_scale(options, steps_of(surfaces));
  result.voxel = scale.voxel;
  result.truncation = scale.truncation;
  DistanceVolume volume({.voxel = result.voxel,
                         .truncation = result.truncation,
                         .max_memory = options.max_memory,
                         .box = std::nullopt,
                         .num_threads = options.num_threads});
  std::size_t done = 0;
  for (const RangeSurface& surface : surfaces) {
    volume.add(surface);
    if (options.progress) options.progress(++done, surfaces.size());
    result.range_triangles += surface.triangles.size();
    result.skipped_points += surface.skipped_points;
  }
  result.bricks = volume.size();
  result.mesh =
      extract_surface(volume, {.cells_from = std::nullopt, .num_threads = options.num_threads})
          .mesh;
  return result;
}

}  // namespace facula
