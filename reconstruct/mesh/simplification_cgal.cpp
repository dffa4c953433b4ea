// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/core/error.hpp>
#include <facula/reconstruct/cgal_bridge.hpp>
#include <facula/reconstruct/mesh/mesh_cleaning.hpp>
#include <facula/reconstruct/mesh/meshing.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>

namespace facula {
namespace {

namespace sms = CGAL::Surface_mesh_simplification;
using Kernel = CGAL::Simple_cartesian<double>;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

constexpr int kAttempts = 6;

/// Ends at a number of triangles or at a cost, whichever comes first.
class Stop {
 public:
  Stop(std::size_t edges, double cost) : edges_(edges), cost_(cost) {}

  template <typename Cost, typename Profile, typename Count>
  bool operator()(const Cost& cost, const Profile&, Count, Count edges) const {
    return edges <= edges_ || cost > cost_;
  }

 private:
  std::size_t edges_;
  double cost_;
};

TriangleMesh collapsed(const TriangleMesh& mesh, std::size_t triangles, double cost) {
  Surface surface = to_cgal<Kernel::Point_3>(mesh);
  // A closed mesh has three edges for two triangles; an open one slightly more.
  const std::size_t spare = surface.number_of_edges() - (3 * surface.number_of_faces()) / 2;
  const std::size_t edges = triangles == 0 ? 0 : 3 * triangles / 2 + std::min(spare, triangles / 2);
  using Policies = sms::GarlandHeckbert_plane_policies<Surface, Kernel>;
  const Policies policies(surface);
  const sms::Bounded_normal_change_placement<Policies::Get_placement> placement(
      policies.get_placement());
  sms::edge_collapse(surface,
                     Stop(edges, cost),
                     CGAL::parameters::get_cost(policies.get_cost()).get_placement(placement));
  surface.collect_garbage();
  return from_cgal(surface);
}

double largest_distance(const TriangleMesh& from, const TriangleMesh& to, int num_threads) {
  const auto distances = distances_to_mesh(from.vertices, to, num_threads);
  return *std::max_element(distances.begin(), distances.end());
}

}  // namespace

void SimplifyOptions::check() const {
  require(triangles > 0 || max_error > 0, "nothing to simplify to; give triangles or max_error");
  require(triangles == 0 || triangles >= 4, "triangles is ", triangles, "; give 4 or more");
  require(
      max_error >= 0 && std::isfinite(max_error), "max_error is ", max_error, " m; give 0 or more");
}

TriangleMesh simplified(const TriangleMesh& mesh, const SimplifyOptions& options) {
  options.check();
  require(!mesh.empty(), "the mesh has no triangles; there is nothing to simplify");
  if (options.max_error == 0) {
    return collapsed(mesh, options.triangles, std::numeric_limits<double>::infinity());
  }
  // A quadric is a sum of squared distances, so its root bounds each of them, but only to the
  // planes of the triangles: what was reached is measured, and the bound on the quadric bisected.
  TriangleMesh best = mesh;
  double kept = 0;
  double exceeded = 2 * options.max_error;
  for (int attempt = 0; attempt < kAttempts && exceeded > 1.2 * kept; ++attempt) {
    const double bound = (kept + exceeded) / 2;
    TriangleMesh result = collapsed(mesh, options.triangles, bound * bound);
    if (largest_distance(mesh, result, options.num_threads) > options.max_error) {
      exceeded = bound;
      continue;
    }
    kept = bound;
    best = std::move(result);
    if (attempt == 0) break;  // the whole bound was of use
  }
  return best;
}

}  // namespace facula
