// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/cgal_bridge.hpp>
#include <facula/reconstruct/filter/cloud_filters.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>
#include <facula/reconstruct/mesh/mesh_engines.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Random.h>
#include <CGAL/poisson_surface_reconstruction.h>
#include <CGAL/property_map.h>

namespace facula {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Oriented = std::pair<Kernel::Point_3, Kernel::Vector_3>;

/// The points with usable normals, one per voxel, about their centre.
std::vector<Oriented> oriented_points(const PointCloud& cloud, const Eigen::Vector3f& centre) {
  std::vector<Oriented> points;
  points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f p = cloud.points[i] - centre;
    const Eigen::Vector3f& n = cloud.normals[i];
    if (!n.allFinite() || n.squaredNorm() < 0.25F) continue;
    points.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()),
                        Kernel::Vector_3(n.x(), n.y(), n.z()));
  }
  return points;
}

/// Exactly; CGAL's solver has no cell to work in where they do, and crashes.
bool lie_on_one_plane(const std::vector<Oriented>& points) {
  const Kernel::Point_3& first = points.front().first;
  const auto second = std::find_if(
      points.begin(), points.end(), [&](const Oriented& p) { return p.first != first; });
  if (second == points.end()) return true;
  const auto third = std::find_if(points.begin(), points.end(), [&](const Oriented& p) {
    return !CGAL::collinear(first, second->first, p.first);
  });
  if (third == points.end()) return true;
  return std::all_of(points.begin(), points.end(), [&](const Oriented& p) {
    return CGAL::coplanar(first, second->first, third->first, p.first);
  });
}

/// CGAL's order follows the addresses of its cells, which differ from run to run.
void put_in_order(std::vector<TriangleMesh::Triangle>& triangles) {
  for (auto& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
}

}  // namespace

void PoissonOptions::check() const {
  require(spacing >= 0 && std::isfinite(spacing), "spacing is ", spacing, " m; give 0 or more");
  require(min_angle > 0 && min_angle < 0.52, "min_angle is ", min_angle, " rad; give 0 to 0.52");
  require(size > 0 && error > 0, "size and error are ", size, " and ", error, "; give above 0");
}

TriangleMesh mesh_poisson(const PointCloud& cloud, const PoissonOptions& options) {
  options.check();
  require(cloud.normals.size() == cloud.size() && !cloud.empty(),
          "Poisson needs a normal at every point, the cloud has ",
          cloud.normals.size(),
          " for ",
          cloud.size(),
          " points; estimate them first");
  const PointCloud finite = surface_points(cloud);
  const SamplingDistance sampling = sampling_distance(finite);
  const double spacing =
      options.spacing > 0 ? options.spacing : 2 * std::max(sampling.nearest, sampling.across);
  require(spacing > 0, "the points all lie on each other; Poisson needs distinct points");
  const PointCloud even = thin_by_voxel(finite, spacing);
  const Eigen::Vector3f centre = even.points.front();
  std::vector<Oriented> points = oriented_points(even, centre);
  require(points.size() >= 4,
          "Poisson needs at least 4 points with normals, the cloud has ",
          points.size(),
          " apart by ",
          1000 * spacing,
          " mm");
  require(!lie_on_one_plane(points),
          "Poisson looks for the skin of a body, and the ",
          points.size(),
          " points lie on one plane; take the advancing front, which lays a surface through them");
  CGAL::get_default_random() = CGAL::Random(1);  // it draws the first points of the contour
  CGAL::Surface_mesh<Kernel::Point_3> surface;
  const bool solved =
      CGAL::poisson_surface_reconstruction_delaunay(points.begin(),
                                                    points.end(),
                                                    CGAL::First_of_pair_property_map<Oriented>(),
                                                    CGAL::Second_of_pair_property_map<Oriented>(),
                                                    surface,
                                                    spacing,
                                                    options.min_angle * 180 / M_PI,
                                                    options.size,
                                                    options.error);
  require(solved && surface.number_of_faces() > 0,
          "Poisson found no surface in ",
          points.size(),
          " points; check that the normals all look outward");
  TriangleMesh mesh = from_cgal(surface);
  put_in_order(mesh.triangles);
  for (Eigen::Vector3f& v : mesh.vertices) v += centre;
  orient_by_points(mesh, even);
  return mesh;
}

}  // namespace facula
