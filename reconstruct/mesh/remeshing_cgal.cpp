// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/cgal_bridge.hpp>
#include <facula/reconstruct/mesh/mesh_cleaning.hpp>

#include <cmath>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>

namespace facula {

TriangleMesh remeshed(const TriangleMesh& mesh, double edge) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  require(edge > 0 && std::isfinite(edge),
          "an edge length of ",
          1000 * edge,
          " mm was asked for; give one above 0");
  const double fewest = mesh_statistics(mesh).area / (edge * edge);
  require(fewest < 1e8,
          "edges of ",
          1000 * edge,
          " mm would need ",
          2.3 * fewest,
          " triangles; give a longer edge");
  CGAL::Surface_mesh<Kernel::Point_3> surface = to_cgal<Kernel::Point_3>(mesh);
  CGAL::Polygon_mesh_processing::isotropic_remeshing(
      surface.faces(), edge, surface, CGAL::parameters::number_of_iterations(3));
  surface.collect_garbage();
  return from_cgal(surface);
}

}  // namespace facula
