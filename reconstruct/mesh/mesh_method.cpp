// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/normals.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>
#include <facula/reconstruct/mesh/mesh_engines.hpp>
#include <facula/reconstruct/mesh/mesh_method.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

namespace facula {
namespace {

/// Normals that look to all sides cancel out; those of a half sphere leave a half.
constexpr double kAllSides = 0.3;

struct Named {
  MeshMethod method;
  const char* name;
};
constexpr std::array<Named, 5> kMethods{{{MeshMethod::kVolumetric, "volumetric"},
                                         {MeshMethod::kPoisson, "poisson"},
                                         {MeshMethod::kAdvancingFront, "advancing-front"},
                                         {MeshMethod::kScaleSpace, "scale-space"},
                                         {MeshMethod::kAlphaWrap, "alpha-wrap"}}};

/// Length of the mean unit vector towards the outside: 0 all around, 1 all one way.
double one_sidedness(const PointCloud& cloud) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f outward = cloud.normals.empty()
                                        ? Eigen::Vector3f(cloud.sensor_origin[i] - cloud.points[i])
                                        : cloud.normals[i];
    if (!outward.allFinite()) continue;
    sum += outward.cast<double>().stableNormalized();
    ++count;
  }
  return count > 0 ? sum.norm() / count : 1;
}

bool seen_along_lines(const PosedCloud& scan) {
  return !scan.grid.empty() && !scan.cloud.sensor_origin.empty();
}

/// All points, evened out.
PointCloud even_cloud(const ScanProject& project, const MeshScansOptions& options, double& voxel) {
  const PointCloud all = project.fused();
  voxel = options.voxel > 0 ? options.voxel : evening_voxel(all);
  return voxel > 0 ? thin_by_voxel(all, voxel) : all;
}

TriangleMesh mesh_points(const PointCloud& cloud,
                         MeshMethod method,
                         const MeshScansOptions& options) {
  switch (method) {
    case MeshMethod::kPoisson: {
      PointCloud oriented = cloud;
      if (oriented.normals.empty()) {
        estimate_normals(oriented, {.neighbours = 20, .num_threads = options.num_threads});
      }
      return mesh_poisson(oriented, {.spacing = options.voxel});
    }
    case MeshMethod::kScaleSpace:
      return mesh_scale_space(cloud, {.max_edge = options.max_edge});
    case MeshMethod::kAlphaWrap:
      return wrap_points(cloud);
    default:
      return mesh_advancing_front(cloud, {.max_edge = options.max_edge});
  }
}

MethodChoice choose_for_cloud(const PointCloud& cloud) {
  std::ostringstream reason;
  if (cloud.normals.empty() && cloud.sensor_origin.empty()) {
    return {MeshMethod::kScaleSpace,
            "scale space, since the points have neither normals nor a place they were seen from"};
  }
  const double one_sided = one_sidedness(cloud);
  reason << (cloud.normals.empty() ? "lines of sight" : "normals");
  reason.precision(2);
  if (one_sided < kAllSides) {
    reason << " come from all sides (their mean has length " << one_sided
           << "), so the points go around something that Poisson can close";
    return {MeshMethod::kPoisson, "Poisson, since the " + reason.str()};
  }
  reason << " come mostly from one side (their mean has length " << one_sided
         << "), so the surface is open and Poisson would invent the rest";
  return {MeshMethod::kAdvancingFront, "advancing front, since the " + reason.str()};
}

}  // namespace

std::string to_string(MeshMethod method) {
  for (const Named& named : kMethods) {
    if (named.method == method) return named.name;
  }
  return "unknown";
}

MeshMethod mesh_method(const std::string& name) {
  std::string all;
  for (const Named& named : kMethods) {
    if (name == named.name) return named.method;
    all += std::string(all.empty() ? "" : ", ") + named.name;
  }
  fail("expected a mesh method (", all, "), got '", name, "'");
}

MethodChoice choose_method(const ScanProject& project) {
  std::size_t points = 0;
  std::size_t in_grids = 0;
  std::size_t grids = 0;
  for (const PosedCloud& scan : project.scans) {
    points += scan.cloud.size();
    if (!seen_along_lines(scan)) continue;
    in_grids += scan.cloud.size();
    ++grids;
  }
  require(points > 0, "there are no points to mesh");
  if (2 * in_grids < points) return choose_for_cloud(project.fused());
  std::ostringstream reason;
  reason << "volumetric, since " << grids << (grids == 1 ? " scan has" : " scans have")
         << " a grid and lines of sight, whose noise it averages";
  return {MeshMethod::kVolumetric, reason.str()};
}

void MeshScansOptions::check() const {
  require(voxel >= 0 && std::isfinite(voxel), "voxel is ", voxel, " m; give 0 or more");
  require(max_edge >= 0 && std::isfinite(max_edge), "max_edge is ", max_edge, " m; give 0 or more");
}

MeshedScans mesh_scans(const ScanProject& project,
                       MeshMethod method,
                       const MeshScansOptions& options) {
  options.check();
  MeshedScans result;
  if (method == MeshMethod::kVolumetric) {
    VolumetricResult merged = merge_volumetric(project,
                                               {.voxel = options.voxel,
                                                .max_memory = options.max_memory,
                                                .num_threads = options.num_threads});
    for (const PosedCloud& scan : project.scans) result.points += scan.cloud.size();
    result.mesh = std::move(merged.mesh);
    result.voxel = merged.voxel;
    return result;
  }
  const PointCloud cloud = even_cloud(project, options, result.voxel);
  result.points = cloud.size();
  result.mesh = mesh_points(cloud, method, options);
  return result;
}

}  // namespace facula
