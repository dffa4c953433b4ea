// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/cgal_bridge.hpp>
#include <facula/reconstruct/filter/sampling_distance.hpp>
#include <facula/reconstruct/mesh/mesh_engines.hpp>

#include <algorithm>
#include <cmath>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/alpha_wrap_3.h>

namespace facula {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

std::vector<Kernel::Point_3> to_cgal(const std::vector<Eigen::Vector3f>& points) {
  std::vector<Kernel::Point_3> result;
  result.reserve(points.size());
  for (const Eigen::Vector3f& p : points) result.emplace_back(p.x(), p.y(), p.z());
  return result;
}

double offset_of(const AlphaWrapOptions& options, double alpha) {
  return options.offset > 0 ? options.offset : alpha / 6;
}

}  // namespace

void AlphaWrapOptions::check() const {
  require(alpha >= 0 && std::isfinite(alpha), "alpha is ", alpha, " m; give 0 or more");
  require(offset >= 0 && std::isfinite(offset), "offset is ", offset, " m; give 0 or more");
}

TriangleMesh wrap_points(const PointCloud& cloud, const AlphaWrapOptions& options) {
  options.check();
  const PointCloud input = surface_points(cloud);
  const SamplingDistance sampling = sampling_distance(input);
  const double alpha =
      options.alpha > 0 ? options.alpha : 4 * std::max(sampling.nearest, sampling.across);
  require(alpha > 0, "the points all lie on each other; a wrap needs distinct points");
  Surface wrap;
  CGAL::alpha_wrap_3(to_cgal(input.points), alpha, offset_of(options, alpha), wrap);
  return from_cgal(wrap);
}

TriangleMesh wrap_mesh(const TriangleMesh& mesh, const AlphaWrapOptions& options) {
  options.check();
  mesh.check();
  require(options.alpha > 0, "alpha is 0 m; a wrap of a mesh needs one");
  std::vector<std::array<std::size_t, 3>> faces;
  for (const auto& [a, b, c] : mesh.triangles) {
    const bool finite = mesh.vertices[a].allFinite() && mesh.vertices[b].allFinite() &&
                        mesh.vertices[c].allFinite();
    if (finite) faces.push_back({a, b, c});
  }
  require(!faces.empty(), "the mesh has no triangle; a wrap needs something to wrap");
  Surface wrap;
  CGAL::alpha_wrap_3(
      to_cgal(mesh.vertices), faces, options.alpha, offset_of(options, options.alpha), wrap);
  return from_cgal(wrap);
}

}  // namespace facula
