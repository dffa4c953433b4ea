// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/cgal_bridge.hpp>
#include <facula/reconstruct/mesh/mesh_cleaning.hpp>

#include <algorithm>
#include <cmath>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <Eigen/Geometry>

namespace facula {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;
using HalfEdge = Surface::Halfedge_index;

constexpr double kSmall = 0.4;            ///< share of the mesh's extent [1]
constexpr std::size_t kMostEdges = 4000;  ///< minutes of work beyond [1]
// Where no triangulation lies in the rim's Delaunay tetrahedra, all triangulations are searched in
// time that grows with the cube of the edges: some seconds for so many.
constexpr std::size_t kMostCubicEdges = 1000;

struct Loop {
  HalfEdge start;
  std::size_t edges = 0;
  double diameter = 0;
};

/// The boundary loops in the order of their first half-edge.
std::vector<Loop> loops_of(const Surface& surface) {
  std::vector<Loop> loops;
  std::vector<bool> seen(surface.number_of_halfedges(), false);
  for (const HalfEdge start : surface.halfedges()) {
    if (!surface.is_border(start) || seen[static_cast<std::size_t>(start)]) continue;
    Loop loop{start, 0, 0};
    Eigen::AlignedBox3d box;
    for (HalfEdge half = start; !seen[static_cast<std::size_t>(half)]; half = surface.next(half)) {
      seen[static_cast<std::size_t>(half)] = true;
      const Kernel::Point_3& p = surface.point(surface.target(half));
      box.extend(Eigen::Vector3d(p.x(), p.y(), p.z()));
      ++loop.edges;
    }
    loop.diameter = box.diagonal().norm();
    loops.push_back(loop);
  }
  return loops;
}

/// A patch of continuous slope where the hole is small beside the mesh; a large one is spanned like
/// a skin, since its rim says little about its middle (half a sphere would be blown up).
bool fill(Surface& surface, const Loop& loop, bool small) {
  std::vector<Surface::Face_index> faces;
  std::vector<Surface::Vertex_index> vertices;
  CGAL::Polygon_mesh_processing::triangulate_refine_and_fair_hole(
      surface,
      loop.start,
      std::back_inserter(faces),
      std::back_inserter(vertices),
      CGAL::parameters::use_delaunay_triangulation(true)
          .do_not_use_cubic_algorithm(loop.edges > kMostCubicEdges)
          .fairing_continuity(small ? 1 : 0));
  return !faces.empty();
}

}  // namespace

TriangleMesh fill_holes(const TriangleMesh& mesh, double max_diameter, std::size_t* filled) {
  require(max_diameter >= 0, "max_diameter is ", max_diameter, " m; give 0 or more");
  Surface surface = to_cgal<Kernel::Point_3>(mesh);
  const std::size_t before = surface.number_of_vertices();
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& v : mesh.vertices) box.extend(v);
  const double extent = mesh.vertices.empty() ? 0 : box.diagonal().norm();
  std::size_t count = 0;
  for (const Loop& loop : loops_of(surface)) {
    if (loop.diameter > max_diameter || loop.edges > kMostEdges) continue;
    if (fill(surface, loop, loop.diameter < kSmall * extent)) ++count;
  }
  if (filled != nullptr) *filled = count;
  TriangleMesh result = from_cgal(surface);
  // The vertices of the mesh come first and have not moved; those of the patches have no colour.
  if (!mesh.colors.empty() && result.vertices.size() == before) result.colors = mesh.colors;
  return result;
}

}  // namespace facula
