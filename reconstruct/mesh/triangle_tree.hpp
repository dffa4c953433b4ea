// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <facula/acquire/core/triangle_mesh.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace facula {

/// Boxes within boxes over the triangles of a mesh: a balanced binary tree over the triangles in
/// the order of their centres' Morton codes. Queries are const and may run from several threads.
class TriangleTree {
 public:
  /// Triangles with a corner that is not finite are left out.
  explicit TriangleTree(const TriangleMesh& mesh);

  bool empty() const { return order_.empty(); }

  struct Nearest {
    double squared_distance = std::numeric_limits<double>::infinity();  ///< [m^2]
    std::uint32_t triangle = 0;                                         ///< of the mesh [1]
  };

  /// The nearest triangle to a finite point closer than the squared distance `within` [m^2]; the
  /// squared distance stays infinite where there is none.
  Nearest nearest(const Eigen::Vector3d& point,
                  double within = std::numeric_limits<double>::infinity()) const;

  /// The nearest triangle to a finite point, whichever the guess is; faster where the guess is
  /// near.
  Nearest nearest_from(const Eigen::Vector3d& point, std::uint32_t guess) const;

  /// Adds to `found` the triangles of a higher number whose boxes meet that of `triangle`.
  void add_meeting(std::uint32_t triangle, std::vector<std::uint32_t>& found) const;

 private:
  struct Box {
    std::array<float, 3> low;
    std::array<float, 3> high;
  };

  Box box_of(std::uint32_t triangle) const;
  double squared_distance(const Box& box, const Eigen::Vector3d& point) const;
  void descend(const Eigen::Vector3d& point, Nearest& best) const;
  void search_leaf(std::size_t leaf, const Eigen::Vector3d& point, Nearest& best) const;

  std::vector<std::array<Eigen::Vector3f, 3>> corners_;  ///< per triangle of the mesh
  std::vector<std::uint32_t> order_;                     ///< triangles along the Morton curve
  std::size_t leaves_ = 0;                               ///< a power of two
  std::vector<Box> boxes_;                               ///< node i has children 2 i and 2 i + 1
};

/// Squared distance from a point to a triangle [m^2] (Ericson, Real-Time Collision Detection, 2005,
/// section 5.1.5); triangles may be needles or points.
double squared_distance_to_triangle(const Eigen::Vector3d& point,
                                    const std::array<Eigen::Vector3f, 3>& corners);

}  // namespace facula
