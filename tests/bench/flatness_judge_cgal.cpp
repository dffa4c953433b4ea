// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/tests/bench/flatness_judge_cgal.hpp>
#include <facula/tests/reconstruct/width_judge_cgal.hpp>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

namespace facula {

double cgal_hull_and_width(const std::vector<Eigen::Vector3d>& points, double unit) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> input;
  input.reserve(points.size());
  for (const Eigen::Vector3d& p : points) input.emplace_back(p.x(), p.y(), p.z());
  CGAL::Surface_mesh<Kernel::Point_3> hull;
  CGAL::convex_hull_3(input.begin(), input.end(), hull);
  std::vector<Eigen::Vector3d> corners;
  for (const auto v : hull.vertices()) {
    const Kernel::Point_3& p = hull.point(v);
    corners.emplace_back(p.x(), p.y(), p.z());
  }
  return judged_width(corners, unit);
}

}  // namespace facula
